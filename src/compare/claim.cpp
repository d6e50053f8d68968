#include "compare/claim.h"

#include <algorithm>
#include <cmath>

#include "compare/fit_sums.h"

namespace echocine::compare {

namespace {

// Places of the sector do not change their sight over the beat.
BeatPlace anyPicture(const EchoStack& real) {
  BeatPlace at;
  for (int p = 0; p < real.pictures(); ++p)
    if (real.seen(p)) {
      at.pictures[0] = p;
      break;
    }
  return at;
}

double sectorArea(const EchoStack& real, const BeatPlace& at) {
  constexpr double kStep_m = 3e-3;
  const int steps = static_cast<int>(std::ceil(real.far() / kStep_m));
  double area = 0;
  for (int i = -steps; i <= steps; ++i)
    for (int k = 0; k <= steps; ++k)
      area += static_cast<double>(real.at(at, kStep_m * i, kStep_m * k).in_sight);
  return area * kStep_m * kStep_m;
}

}  // namespace

double claimedShare(const ModelLoop& model, const EchoStack& real, const FitPose& pose) {
  const BeatPlace at = anyPicture(real);
  const PoseMapping map(pose, model.far_m);
  double cells = 0;
  for (const ModelFrame& frame : model.frames)
    for (const TissueCell& cell : frame.cells) {
      if (!(cell.area > 0)) continue;
      double x, z;
      map.place(cell.x_m, cell.z_m, x, z);
      cells += static_cast<double>(cell.area * real.at(at, x, z).in_sight);
    }
  const double sector = sectorArea(real, at),
               claimed = cells / static_cast<double>(model.frames.size()) /
                         cellsPerArea(model, {}) * map.scale() * map.scale();
  return sector > 0 ? std::clamp(claimed / sector, 0.0, 1.0) : 0;
}

double pictureLeft(double discrepancy, double claimed) {
  return std::pow(discrepancy, claimed);
}

}  // namespace echocine::compare
