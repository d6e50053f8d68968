#pragma once
// Repeats draws until a valid heart results.

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "dataset/draws.h"

namespace echocine::dataset {

inline constexpr int kMaxDraws = 50;

// The result of `make` for the first possible draw of a heart. Reasons of earlier draws are added
// to `impossible`. A draw is impossible if `make` throws SceneError. Throws SceneError if kMaxDraws
// draws were impossible.
template <typename Make>
auto firstPossible(const Spec& spec, int heart, const Make& make,
                   std::vector<std::string>& impossible) {
  std::optional<decltype(make(std::declval<const Draw&>()))> made;
  for (int tried = 0; tried < kMaxDraws && !made; ++tried) {
    try {
      made = make(drawOf(spec, heart, tried));
    } catch (const SceneError& error) {
      impossible.emplace_back(error.what());
    }
  }
  if (!made)
    throw SceneError(fmt::format("{} draws were impossible, the last because of {}", kMaxDraws,
                                 impossible.back()));
  return std::move(*made);
}

}  // namespace echocine::dataset
