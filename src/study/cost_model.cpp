#include "study/cost_model.h"

namespace echocine {

double modelledCost_ms(const Scene& scene, const LoopPlan& plan, const WorkCounts& work,
                       std::size_t vertices) {
  // Nanoseconds each. A vertex: interpolated, refined, its height taken; its normal; refitted in
  // the hierarchy. A facet on the plane: integrated over the cell, or cut alone. A straight piece
  // of ray through the hierarchy takes longer in finer meshes. A sample: filled, averaged,
  // compressed, written. A pixel: scan-converted, encoded.
  constexpr double kVertex = 30, kNormal = 15, kRefit = 90, kCell = 130, kCut = 20, kCrossing = 150,
                   kRayPerTriangle = 1, kSample = 30, kPixel = 4;
  const double v = static_cast<double>(vertices);
  const double samples = static_cast<double>(scene.probe.lines) * scene.probe.samples;
  const double pixels = static_cast<double>(scene.output.width) * scene.output.height;
  double ns = kVertex * v + kCrossing * static_cast<double>(work.crossings) + kSample * samples +
              kPixel * pixels;
  if (scene.accuracy.normals == Normals::smooth) ns += kNormal * v;
  if (plan.slice)
    ns += (plan.cell_echoes ? kCell : kCut) * static_cast<double>(work.facets_sliced);
  else
    ns += kRefit * v + kRayPerTriangle * static_cast<double>(work.rays) *
                           static_cast<double>(plan.triangles_kept);
  return 1e-6 * ns;
}

}  // namespace echocine
