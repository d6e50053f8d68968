#include "fit/plane_tilt.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/check.h"
#include "core/error.h"
#include "core/units.h"
#include "fit/cpu_seconds.h"
#include "fit/descent.h"
#include "frame/simulator.h"

namespace echocine::fit {

namespace {

// Of Unknowns: an angle's unit is a degree.
PlaneTilt tiltAt(const Unknowns& u) {
  return {radiansFromDegrees(u[0]), radiansFromDegrees(u[1])};
}

// By which the best beats planes that lie half of the range away in one angle, whatever the other.
double confidenceIn(std::size_t angle, const Descent& best, const std::vector<Descent>& lattice,
                    double most_deg, double baseline) {
  double rival = 2;
  for (const Descent& d : lattice)
    if (std::abs(d.at[angle] - best.at[angle]) >= most_deg / 2) rival = std::min(rival, d.value);
  return confidenceOf(best.value, rival, baseline);
}

}  // namespace

void checkTilt(double tilt_deg) {
  if (!(tilt_deg >= 0 && tilt_deg <= kMostTilt_deg))
    throw SceneError(fmt::format("--tilt: {:g} is not accepted: a number from 0 to {:g}, degrees",
                                 tilt_deg, kMostTilt_deg));
}

TiltFound searchTilt(const ModelAtTilt& model, const ModelDiscrepancy& discrepancy,
                     const PoseFound& start, double most_deg, const Monitor& monitor) {
  CHECK_LT(0.0, most_deg);
  const double since = cpuSeconds();
  std::atomic<int> planes = 0;
  const PoseFunction least = oneByOne([&](const Unknowns& u) {
    if (!monitor.keep_going()) throw JobError("stopped during the search for the tilt");
    ++planes;
    return discrepancy.refine(model(tiltAt(u)), {start.pose}).discrepancy;
  });
  SearchBox box;
  for (const std::size_t angle : {0, 1}) {
    box.high[angle] = most_deg;
    box.low[angle] = -most_deg;
  }
  const std::vector<Descent> all = lattice(least, box, {2, 2, 0, 0});
  const Descent best = leastApart(descendAll(least, leastApart(all, 2), box), 1).front();
  TiltFound out;
  out.tilt = tiltAt(best.at);
  out.most_deg = most_deg;
  out.untilted = start.discrepancy;
  out.at_limit = box.atLimit(best.at);
  const ModelLoop tilted = model(out.tilt);
  out.found = discrepancy.searchAlsoFrom(tilted, {start.pose});
  out.planes = planes + 1;
  std::vector<double> values;
  for (const Descent& d : all) values.push_back(d.value);
  std::sort(values.begin(), values.end());
  const double median = values[values.size() / 2];
  out.tilt_confidence = confidenceIn(0, best, all, most_deg, median);
  out.rotate_confidence = confidenceIn(1, best, all, most_deg, median);
  out.cpu_ms = 1e3 * (cpuSeconds() - since);
  return out;
}

TiltFound searchTilt(const Simulator& model, const ModelDiscrepancy& discrepancy, double most_deg,
                     const Monitor& monitor) {
  const TiltableModel tiltable(model.scene(), model.motion(), kFitFrames);
  return searchTilt([&](const PlaneTilt& tilt) { return tiltable.at(tilt); }, discrepancy,
                    discrepancy.search(tiltable.at({})), most_deg, monitor);
}

}  // namespace echocine::fit
