#pragma once
// Typed indices, so that indices of different kinds cannot be confused.

#include <bitset>
#include <cstddef>
#include <cstdint>

namespace echocine {

enum class MediumId : std::uint32_t {};
enum class SurfaceId : std::uint32_t {};  // position of a structure in Scene::structures

// Largest number of structures of a scene, so that sets of them fit in a few words.
inline constexpr std::size_t kMaxSurfaces = 256;
using SurfaceSet = std::bitset<kMaxSurfaces>;  // by SurfaceId

template <typename Id>
constexpr std::size_t index(Id id) {
  return static_cast<std::size_t>(id);
}

}  // namespace echocine
