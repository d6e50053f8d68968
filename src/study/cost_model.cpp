#include "study/cost_model.h"

#include <cmath>

namespace echocine {

double modelledCost_ms(const Scene& scene, const LoopPlan& plan, const WorkCounts& work,
                       std::size_t vertices) {
  // Nanoseconds each. A vertex: interpolated, refined, part of a volume; its normal; refitted in
  // the hierarchy. A facet on the plane: cut alone, or integrated over the cell too. A straight
  // piece of ray goes down the levels of the hierarchy. A sample: filled, averaged, compressed,
  // written. A pixel: scan-converted, encoded.
  constexpr double kVertex = 15, kNormal = 15, kRefit = 20, kCell = 150, kCut = 70, kCrossing = 50,
                   kRayPerLevel = 60, kSample = 11, kPixel = 3;
  const double v = static_cast<double>(vertices);
  const double samples = static_cast<double>(scene.probe.lines) * scene.probe.samples;
  const double pixels = static_cast<double>(scene.output.width) * scene.output.height;
  double ns = kVertex * v + kCrossing * static_cast<double>(work.crossings) + kSample * samples +
              kPixel * pixels;
  if (scene.accuracy.normals == Normals::smooth) ns += kNormal * v;
  if (plan.slice)
    ns += (plan.cell_echoes ? kCell : kCut) * static_cast<double>(work.facets_sliced);
  else
    ns += kRefit * v + kRayPerLevel * static_cast<double>(work.rays) *
                           std::log2(1.0 + static_cast<double>(plan.triangles_kept));
  return 1e-6 * ns;
}

}  // namespace echocine
