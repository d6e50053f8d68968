#pragma once
// Embree with one mesh that moves: which of its triangles rays may meet.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/frame_geometry.h"

struct RTCSceneTy;
struct RTCGeometryTy;

namespace echocine {

class EmbreeMesh {
 public:
  static constexpr std::size_t kPacket = 16;  // rays that go together
  using Candidates = std::array<std::vector<std::uint32_t>, kPacket>;

  // Errors, of all that follows: std::bad_alloc, JobError.
  EmbreeMesh();
  ~EmbreeMesh();
  EmbreeMesh(const EmbreeMesh&) = delete;
  EmbreeMesh& operator=(const EmbreeMesh&) = delete;

  // Once, before anything else. Without triangles no ray meets any.
  void reserve(std::size_t vertices, std::size_t triangles);

  // To be filled; nothing without triangles.
  Vec3f* vertices() { return vertices_; }
  Triangle* triangles() { return triangles_; }

  // Takes over vertices that have moved.
  void refit();

  // The triangles that each of up to 16 rays may meet, in any order; one at a shared edge or vertex
  // may be missing or stand there twice. Thread-safe between refits.
  void candidates(std::span<const RayQuery> rays, Candidates& found) const;

 private:
  RTCSceneTy* scene_;
  RTCGeometryTy* mesh_;
  Vec3f* vertices_ = nullptr;
  Triangle* triangles_ = nullptr;
};

}  // namespace echocine
