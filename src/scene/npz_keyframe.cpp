#include "scene/npz_keyframe.h"

#include <fmt/format.h>

#include <charconv>
#include <string>
#include <string_view>

#include "core/npz_reader.h"
#include "scene/ranges.h"

namespace echocine {

namespace {

constexpr std::string_view kNpz = ".npz";

}  // namespace

std::optional<NpzKeyframe> npzKeyframeOf(const std::filesystem::path& name) {
  const std::string text = name.string();
  if (text.ends_with(kNpz)) return NpzKeyframe{name, std::nullopt};
  const std::size_t open = text.rfind('[');
  if (open == std::string::npos || !text.ends_with("]") ||
      !std::string_view(text).substr(0, open).ends_with(kNpz))
    return std::nullopt;
  std::size_t keyframe = 0;
  const char* const last = text.data() + text.size() - 1;
  const auto [end, error] = std::from_chars(text.data() + open + 1, last, keyframe);
  if (error != std::errc{} || end != last) return std::nullopt;
  return NpzKeyframe{text.substr(0, open), keyframe};
}

std::vector<std::filesystem::path> npzKeyframeNames(const std::filesystem::path& file) {
  const NpzReader npz(file);
  const std::vector<std::size_t> shape = npz.header("points").shape;
  if (shape.size() != 3 || shape[0] == 0 || shape[2] != 3)
    npz.fail(fmt::format("points is {}, accepted: (K, V, 3), K keyframes of V vertices",
                         shapeText(shape)));
  if (shape[0] > ranges::kMostKeyframes)
    npz.fail(fmt::format("points has {} keyframes, accepted: up to {}", shape[0],
                         ranges::kMostKeyframes));
  std::vector<std::filesystem::path> names;
  for (std::size_t k = 0; k < shape[0]; ++k)
    names.emplace_back(fmt::format("{}[{}]", file.string(), k));
  return names;
}

}  // namespace echocine
