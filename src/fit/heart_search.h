#pragma once
// The heart that a loop shows in a view: the best of a small population.

#include "fit/dial_grid.h"

namespace echocine::fit {

// The population: adult hearts with EF 0.3 to 0.7 and EDV 80 to 220 mL, from failing to vigorous
// and from small to dilated. Other dials follow or are given. Our choice. Given dials leave the
// population.
std::vector<ScanAxis> populationWithout(const std::map<std::string, double>& given);

struct HeartFound {
  std::vector<double> values;  // of the population's dials, in their order
  PoseFound found;
  double coverage = 0;            // a of coverage.h, Eq. 12
  double left = 1;                // V, Eq. 13
  double middle = 1;              // D of the heart at the centre of all ranges
  int hearts = 0;                 // hearts tried, each with its own pose
  std::optional<TiltFound> tilt;  // of that heart, if requested
};

// The best heart of a coarse grid and of a grid of half the step around its best: the one of lowest
// D, or the minimum of a paraboloid through its neighbours. Grid hearts take the pose of lowest D
// near that of the central heart or of the best so far. The pose of the final heart is searched
// globally. Its plane is then tilted if tilt_deg > 0. Runs in parallel; the result does not depend
// on the threads. Throws JobError when the monitor requests a stop. Precondition: the family's
// dials are the population's, its tilt is tilt_deg.
HeartFound searchHeart(const HeartFamily& family, const std::vector<ScanAxis>& population,
                       const ModelDiscrepancy& discrepancy, double tilt_deg = 0,
                       const Monitor& monitor = {});

}  // namespace echocine::fit
