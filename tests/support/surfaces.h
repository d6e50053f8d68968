#pragma once
// Meshes as the geometry stage takes them, in metres in the probe frame.

#include <deque>
#include <random>

#include "geometry/crossing_rule.h"
#include "geometry/frame_geometry.h"
#include "support/meshes.h"

namespace echocine::support {

// One frame with its surfaces; it keeps what the geometry refers to.
class Surfaces {
 public:
  explicit Surfaces(const std::vector<Mesh>& closed, const std::vector<Mesh>& membranes = {}) {
    for (const Mesh& mesh : closed) add(mesh, false);
    for (const Mesh& mesh : membranes) add(mesh, true);
    geometry_.emplace(topology_);
    geometry_->update(frame_);
  }
  Surfaces(const Surfaces&) = delete;
  Surfaces& operator=(const Surfaces&) = delete;

  const FrameGeometry& geometry() const { return *geometry_; }
  const std::vector<SurfaceTopology>& topology() const { return topology_; }

  void move(const std::vector<Mesh>& meshes) {
    for (std::size_t s = 0; s < meshes.size(); ++s) frame_.positions_m[s] = floats(meshes[s]);
    geometry_->update(frame_);
  }

  RayCrossings cross(const Ray& ray) const {
    std::vector<RayQuery> query{{ray, geometry_->insideAt(ray.origin), {}}};
    std::vector<RayCrossings> met(1);
    geometry_->crossings(query, met);
    return met[0];
  }

  // The rule for every triangle of a surface, in no order and without any hierarchy.
  std::vector<Crossing> crossEvery(const Ray& ray, std::uint32_t surface) const {
    const RayPlanes planes(ray);
    std::vector<Crossing> all;
    const std::vector<Vec3f>& p = frame_.positions_m[surface];
    for (std::uint32_t i = 0; i < topology_[surface].triangles.size(); ++i) {
      const Triangle& t = topology_[surface].triangles[i];
      if (const auto c = crossTriangle(planes, p[t[0]], p[t[1]], p[t[2]], SurfaceId{surface}, i))
        all.push_back(*c);
    }
    return all;
  }

 private:
  static std::vector<Vec3f> floats(const Mesh& mesh) {
    std::vector<Vec3f> positions;
    for (const Vec3d& p : mesh.points) positions.push_back(toFloat(p));
    return positions;
  }
  void add(const Mesh& mesh, bool membrane) {
    topology_.push_back({SurfaceId{static_cast<std::uint32_t>(topology_.size())}, mesh.triangles,
                         static_cast<std::uint32_t>(mesh.points.size()), membrane});
    frame_.positions_m.push_back(floats(mesh));
  }

  std::vector<SurfaceTopology> topology_;
  SurfaceFrame frame_;
  std::optional<FrameGeometry> geometry_;
};

// Uniform directions and points; the same ones in every run.
class RandomVectors {
 public:
  explicit RandomVectors(unsigned seed) : engine_(seed) {}
  double number(double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  Vec3d direction() {
    for (;;) {
      const Vec3d v{number(-1, 1), number(-1, 1), number(-1, 1)};
      const double size = length(v);
      if (size > 0.05 && size <= 1) return normalised(v);
    }
  }

 private:
  std::mt19937_64 engine_;
};

inline Ray rayFromTo(Vec3d from, Vec3d to) {
  return {from, normalised(to - from)};
}

}  // namespace echocine::support
