#pragma once
// Whose heart a loop shows in a view: the best one of a small population.

#include "fit/dial_grid.h"

namespace echocine::fit {

// The population: adult hearts from failing to vigorous, EF 0.3 to 0.7, from small to dilated, EDV
// 80 to 220 mL. The rest follows from these two, or is given. Our choice. Dials that are given
// leave it.
std::vector<ScanAxis> populationWithout(const std::map<std::string, double>& given);

struct HeartFound {
  std::vector<double> values;  // of the population's dials, in their order
  PoseFound found;
  double coverage = 0;            // a of coverage.h, Eq. 11
  double left = 1;                // V, Eq. 12
  double middle = 1;              // D of the heart in the middle of all ranges
  int hearts = 0;                 // that were tried, each with a pose of its own
  std::optional<TiltFound> tilt;  // of that heart, where asked for
};

// A grid of hearts, and one of half its steps about the best: that of least D, or the minimum of a
// paraboloid through its neighbours. Hearts of a grid have the pose of least D near those of the
// middle one, or of the best so far; the best has that of least D from everywhere. At last its
// plane is tilted, where tilt_deg is above 0. Runs in parallel. The same input gives the same heart
// whatever the threads. Throws JobError when the monitor wants to stop. Precondition: the family's
// dials are the population's, its tilt is tilt_deg.
HeartFound searchHeart(const HeartFamily& family, const std::vector<ScanAxis>& population,
                       const ModelDiscrepancy& discrepancy, double tilt_deg = 0,
                       const Monitor& monitor = {});

}  // namespace echocine::fit
