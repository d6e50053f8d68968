#pragma once
// Typed indices, so that a medium's number cannot be handed where a structure's is wanted.

#include <cstddef>
#include <cstdint>

namespace echocine {

enum class MediumId : std::uint32_t {};
enum class SurfaceId : std::uint32_t {};  // position of a structure in Scene::structures

template <typename Id>
constexpr std::size_t index(Id id) {
  return static_cast<std::size_t>(id);
}

}  // namespace echocine
