#pragma once
// Embree with one moving mesh: candidate triangles of rays.

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
  static constexpr std::size_t kPacket = 16;  // rays traced together
  using Candidates = std::array<std::vector<std::uint32_t>, kPacket>;

  // All member functions throw std::bad_alloc, JobError.
  EmbreeMesh();
  ~EmbreeMesh();
  EmbreeMesh(const EmbreeMesh&) = delete;
  EmbreeMesh& operator=(const EmbreeMesh&) = delete;

  // Call once, before anything else. Without triangles no ray has candidates.
  void reserve(std::size_t vertices, std::size_t triangles);

  // For the caller to fill; null without triangles.
  Vec3f* vertices() { return vertices_; }
  Triangle* triangles() { return triangles_; }

  // Updates Embree after the vertices have moved.
  void refit();

  // The triangles that each of up to 16 rays may intersect, in any order. At a shared edge or
  // vertex one may be missing or duplicated. Thread-safe between refits.
  void candidates(std::span<const RayQuery> rays, Candidates& found) const;

 private:
  RTCSceneTy* scene_;
  RTCGeometryTy* mesh_;
  Vec3f* vertices_ = nullptr;
  Triangle* triangles_ = nullptr;
};

}  // namespace echocine
