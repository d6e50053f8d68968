#pragma once
// One frame's surfaces prepared for rays: a bounding-volume hierarchy that is refitted as the heart
// moves.

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "geometry/crossing.h"
#include "motion/surfaces/surface_frame.h"

namespace echocine {

// A ray and the known state at its start.
struct RayQuery {
  Ray ray;
  InsideSet inside;  // closed surfaces that contain the origin
  std::vector<std::pair<SurfaceId, std::uint32_t>>
      left_behind;  // triangles on which the origin lies
};

class FrameGeometry {
 public:
  // Surfaces in `left_out` are not intersected. Precondition: `surfaces` outlives the geometry.
  explicit FrameGeometry(const std::vector<SurfaceTopology>& surfaces,
                         const InsideSet& left_out = {});
  ~FrameGeometry();
  FrameGeometry(FrameGeometry&&) noexcept;

  // Copies positions and normals and refits the hierarchy.
  void update(const SurfaceFrame& frame);

  // Closed surfaces that contain the point, by the rule of crossing_rule.h.
  InsideSet insideAt(Vec3d point) const;

  // All crossings of each ray, at any distance. At most 16 rays; out[i].crossings keeps its
  // capacity.
  void crossings(std::span<const RayQuery> rays, std::span<RayCrossings> out) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace echocine
