#include "frame/mesh_placement.h"

#include <fmt/format.h>

#include <cmath>

#include "core/units.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

std::string range(double from_m, double to_m) {
  // Adding zero takes the sign off a rounded "-0".
  const auto rounded = [](double m) { return std::round(millimetresFromMetres(m)) + 0.0; };
  return fmt::format("{:.0f} to {:.0f}", rounded(from_m), rounded(to_m));
}

}  // namespace

Box meshesBox(const MeshMotion& motion) {
  Box box;
  constexpr int kPhases = 8;
  SurfaceFrame frame;
  for (int i = 0; i < kPhases; ++i) {
    motion.frameAt(static_cast<double>(i) / kPhases, frame, false);
    for (const std::vector<Vec3f>& surface : frame.positions_m)
      for (const Vec3f p : surface) box.add(toDouble(p));
  }
  return box;
}

std::string describePlacement(const Scene& scene, const Box& box_m) {
  const Box sector = scanBox(scene.probe);
  const Vec3d middle = 0.5 * (box_m.lo + box_m.hi);
  const Vec3d world = (1 / scene.motion.mesh_unit_m) * scene.probe.pose.toWorld(middle);
  return fmt::format(
      "seen from the probe the meshes fill {} mm along its lateral axis, {} mm across the imaging "
      "plane and {} mm of depth, the sector {} mm, 0 mm and {} mm; their middle is at "
      "[{:.4g}, {:.4g}, {:.4g}] in the units of probe.apex",
      range(box_m.lo.x, box_m.hi.x), range(box_m.lo.y, box_m.hi.y), range(box_m.lo.z, box_m.hi.z),
      range(sector.lo.x, sector.hi.x), range(sector.lo.z, sector.hi.z), world.x, world.y, world.z);
}

}  // namespace echocine
