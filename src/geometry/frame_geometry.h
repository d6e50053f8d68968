#pragma once
// One frame's surfaces ready for rays: a bounding-volume hierarchy that is updated as the heart
// moves.

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "geometry/crossing.h"
#include "motion/surfaces/surface_frame.h"

namespace echocine {

// A ray and what is known of its start.
struct RayQuery {
  Ray ray;
  InsideSet inside;  // closed surfaces that hold the origin
  std::vector<std::pair<SurfaceId, std::uint32_t>> left_behind;  // triangles the origin lies on
};

class FrameGeometry {
 public:
  // Surfaces in `left_out` meet no ray. Precondition: `surfaces` outlives the geometry.
  explicit FrameGeometry(const std::vector<SurfaceTopology>& surfaces,
                         const InsideSet& left_out = {});
  ~FrameGeometry();
  FrameGeometry(FrameGeometry&&) noexcept;

  // Takes over the positions and normals (copies them) and refits the hierarchy.
  void update(const SurfaceFrame& frame);

  // Closed surfaces that hold the point, by the rule of crossing_rule.h.
  InsideSet insideAt(Vec3d point) const;

  // All crossings of each ray, however far. At most 16 rays; out[i].crossings keeps its capacity.
  void crossings(std::span<const RayQuery> rays, std::span<RayCrossings> out) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace echocine
