#pragma once
// Another standard view in which a found heart explains a loop better than in the named one.

#include <map>
#include <optional>
#include <string>

#include "core/monitor.h"
#include "fit/model_discrepancy.h"
#include "motion/heart/heart_poses.h"

namespace echocine::fit {

struct ViewRival {
  heart::View view{};
  double own = 1, other = 1;  // V of Eq. 13
};

// The heart of these dials in the long-axis views a4c, a2c, a3c and plax other than the named one,
// each at its best pose, without tilt. Empty unless one has a lower V than `own` at its pose. Takes
// 2 s of one core for each view. Throws SceneError for impossible dials, JobError if the monitor
// requests a stop. Runs in parallel.
std::optional<ViewRival> betterView(const std::map<std::string, double>& dials, heart::View named,
                                    const ModelDiscrepancy& discrepancy, const ModelLoop& own,
                                    const FitPose& pose, const Monitor& monitor);

}  // namespace echocine::fit
