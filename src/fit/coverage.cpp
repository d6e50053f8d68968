#include "fit/coverage.h"

#include <algorithm>
#include <cmath>

#include "fit/fit_sums.h"

namespace echocine::fit {

namespace {

// Places of the sector do not change their sight over the beat.
echo::EchoInstant anyPicture(const echo::EchoStack& real) {
  echo::BeatPlace at;
  for (int p = 0; p < real.pictures(); ++p)
    if (real.seen(p)) {
      at.pictures[0] = p;
      break;
    }
  return real.instant(at);
}

double sectorArea(const echo::EchoInstant& at) {
  constexpr double kStep_m = 3e-3;
  const int steps = static_cast<int>(std::ceil(at.stack().far() / kStep_m));
  double area = 0;
  for (int i = -steps; i <= steps; ++i)
    for (int k = 0; k <= steps; ++k)
      area += static_cast<double>(at.at(kStep_m * i, kStep_m * k).visible);
  return area * kStep_m * kStep_m;
}

}  // namespace

double coverageOf(const ModelLoop& model, const echo::EchoStack& real, const FitPose& pose) {
  const echo::EchoInstant at = anyPicture(real);
  const PoseMapping map(pose, model.far_m);
  double cells = 0;
  for (const ModelFrame& frame : model.frames)
    for (const TissueCell& cell : frame.cells) {
      if (!(cell.area > 0)) continue;
      double x, z;
      map.place(cell.x_m, cell.z_m, x, z);
      cells += static_cast<double>(cell.area * at.at(x, z).visible);
    }
  const double sector = sectorArea(at), coverage = cells /
                                                   static_cast<double>(model.frames.size()) /
                                                   cellsPerArea(model) * map.scale() * map.scale();
  return sector > 0 ? std::clamp(coverage / sector, 0.0, 1.0) : 0;
}

double pictureDiscrepancy(double discrepancy, double coverage) {
  return std::pow(discrepancy, coverage);
}

}  // namespace echocine::fit
