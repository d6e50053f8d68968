#pragma once
// Scatterers of membranes: each is bound to its triangle and goes where that goes. A leaflet's
// speckle then moves with it through blood that renews itself.

#include <vector>

#include "motion/interior/bound_point.h"
#include "motion/surfaces/mesh_motion.h"
#include "speckle/point_spread.h"

namespace echocine {

class SheetPoints {
 public:
  // Evenly by area at the reference phase, hashed from the seed; those that no beam comes near at
  // any instant are left out. At 3 per resolution cell they stand half a pulse's width apart: many
  // more to a cell than the blood about them, which then hardly shows in the sheet's echo.
  SheetPoints(const Scene& scene, const MeshMotion& motion, double reference_phase);

  std::size_t count() const { return points_.size(); }
  // Places at an instant, in the same order at all. Nothing of a frame without surfaces.
  void at(const SurfaceFrame& surfaces, std::vector<Vec3f>& places_m) const;

 private:
  void draw(const SurfaceTopology& sheet, const std::vector<Vec3f>& positions_m, double per_m2,
            const SpeckleSettings& settings);
  void dropUnseen(const MeshMotion& motion, double reach_m);

  const MeshMotion& motion_;
  std::vector<BoundPoint> points_;
};

}  // namespace echocine
