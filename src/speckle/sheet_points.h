#pragma once
// Scatterers of membranes, bound to their triangles. A leaflet's speckle thus moves with it through
// blood that renews itself.

#include <memory>
#include <span>
#include <vector>

#include "motion/interior/bound_point.h"
#include "motion/surfaces/leaflet_bodies.h"
#include "motion/surfaces/mesh_motion.h"
#include "speckle/point_spread.h"

namespace echocine {

class SheetPoints {
 public:
  // Uniform in area at the reference phase, hashed from the seed; those that no beam reaches at any
  // instant are omitted. At 3 per resolution cell their spacing is half a pulse's width, so a cell
  // contains many more of them than of the surrounding blood, which hardly contributes to the
  // sheet's echo.
  // Those of a leaflet with thickness are spread evenly through its body.
  SheetPoints(const Scene& scene, const MeshMotion& motion, double reference_phase,
              std::shared_ptr<const LeafletBodies> leaflets = nullptr);

  std::size_t count() const { return points_.size(); }
  // Positions at an instant, always in the same order. Empty for a frame without
  // surfaces.
  void at(const SurfaceFrame& surfaces, std::vector<Vec3f>& places_m) const;

 private:
  void draw(const SurfaceTopology& sheet, const std::vector<Vec3f>& positions_m, double per_m2,
            const SpeckleSettings& settings);
  void dropUnseen(std::span<const SurfaceId> sheets, double reach_m);

  const MeshMotion& motion_;
  std::shared_ptr<const LeafletBodies> leaflets_;
  std::vector<BoundPoint> points_;
  std::vector<float> through_;  // of each: -1 at the back of its body to 1 at the front
};

}  // namespace echocine
