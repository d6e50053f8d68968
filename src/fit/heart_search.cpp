#include "fit/heart_search.h"

#include <algorithm>

#include "core/check.h"
#include "fit/coverage.h"

namespace echocine::fit {

std::vector<ScanAxis> populationWithout(const std::map<std::string, double>& given) {
  std::vector<ScanAxis> out;
  for (const ScanAxis& axis : {ScanAxis{{"ef", 0.3, 0.7}, 0.1}, ScanAxis{{"edv", 80, 220}, 35}})
    if (!given.contains(axis.range.key)) out.push_back(axis);
  return out;
}

namespace {

// Half a step either way of a place, within the population.
std::vector<ScanAxis> closerTo(const std::vector<double>& values,
                               const std::vector<ScanAxis>& population) {
  std::vector<ScanAxis> closer = population;
  for (std::size_t a = 0; a < closer.size(); ++a) {
    ScanAxis& axis = closer[a];
    axis.step /= 2;
    axis.range.low = std::max(axis.range.low, values[a] - axis.step);
    axis.range.high = std::min(axis.range.high, values[a] + axis.step);
  }
  return closer;
}

}  // namespace

HeartFound searchHeart(const HeartFamily& family, const std::vector<ScanAxis>& population,
                       const ModelDiscrepancy& discrepancy, double tilt_deg,
                       const Monitor& monitor) {
  CHECK_EQ(family.ranges().size(), population.size());
  const PoseFound centre = discrepancy.search(family.at(middleOf(population)));
  std::vector<FitPose> starts{centre.pose};
  if (!centre.rivals.empty()) starts.push_back(centre.rivals.front().first);
  HeartFound out;
  out.middle = centre.discrepancy;
  const DialGrid grid = holdGrid(population, family, discrepancy, starts, {}, monitor);
  out.hearts = static_cast<int>(grid.points.size()) + 1;
  out.values = grid.points[grid.best].values;
  out.found =
      discrepancy.searchAlsoFrom(family.at(out.values), {grid.points[grid.best].found.pose});
  const auto takeIfLess = [&](const std::vector<double>& values, const FitPose& from) {
    if (values.empty() || values == out.values) return;
    const PoseFound other = discrepancy.searchAlsoFrom(family.at(values), {from});
    ++out.hearts;
    if (other.discrepancy >= out.found.discrepancy) return;
    out.values = values;
    out.found = other;
  };
  takeIfLess(grid.minimum, out.found.pose);
  const DialGrid close = holdGrid(closerTo(out.values, population), family, discrepancy,
                                  {out.found.pose}, {}, monitor);
  out.hearts += static_cast<int>(close.points.size());
  takeIfLess(close.points[close.best].values, close.points[close.best].found.pose);
  takeIfLess(close.minimum, out.found.pose);
  if (tilt_deg > 0) {
    out.tilt = searchTilt([&](const PlaneTilt& tilt) { return family.at(out.values, tilt); },
                          discrepancy, out.found, tilt_deg, monitor);
    out.found = out.tilt->found;
  }
  out.coverage = coverageOf(family.at(out.values, out.tilt ? out.tilt->tilt : PlaneTilt{}),
                            discrepancy.stack(), out.found.pose);
  out.left = pictureDiscrepancy(out.found.discrepancy, out.coverage);
  return out;
}

}  // namespace echocine::fit
