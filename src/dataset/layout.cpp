#include "dataset/layout.h"

#include <algorithm>
#include <cmath>

#include "scene/beam_profile.h"
#include "scene/scan_geometry.h"
#include "truth/plane_labels.h"

namespace echocine::dataset {

std::vector<const Layout*> layoutsOf(const Spec& spec) {
  std::vector<const Layout*> wanted;
  for (const Layout* layout : {&kCamus, &kDicom, &kEchonet, &kMyotracker, &kNative, &kNnunet,
                               &kPointodyssey, &kWebdataset})
    if (spec.has(layout->name)) wanted.push_back(layout);
  return wanted;
}

const char* nameOf(Split split) {
  constexpr const char* kNames[] = {"train", "val", "test"};
  return kNames[static_cast<std::size_t>(split)];
}

bool isShown(const LoopSample& loop, Vec3f place_m) {
  const Probe& probe = loop.scene.probe;
  const auto x = static_cast<double>(place_m.x), z = static_cast<double>(place_m.z);
  if (!inScanArea(probe, x, z)) return false;
  const ScanGeometry geometry(probe);
  const double half_m =
      0.5 * elevationBeamWidth(geometry.pathOf({x, 0, z}), probe.elevation_aperture_m,
                               probe.elevation_focus_m, geometry.wavelength());
  return std::abs(static_cast<double>(place_m.y)) <= half_m;
}

}  // namespace echocine::dataset
