#pragma once
// Typed indices, so that a medium's number cannot be handed where a structure's is wanted.

#include <bitset>
#include <cstddef>
#include <cstdint>

namespace echocine {

enum class MediumId : std::uint32_t {};
enum class SurfaceId : std::uint32_t {};  // position of a structure in Scene::structures

// The most structures a scene may have: sets of them fit in a few words.
inline constexpr std::size_t kMaxSurfaces = 256;
using SurfaceSet = std::bitset<kMaxSurfaces>;  // by SurfaceId

template <typename Id>
constexpr std::size_t index(Id id) {
  return static_cast<std::size_t>(id);
}

}  // namespace echocine
