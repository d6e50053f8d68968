#include "compare/heart_search.h"

#include "compare/claim.h"
#include "core/check.h"

namespace echocine::compare {

std::vector<ScanAxis> populationWithout(const std::map<std::string, double>& given) {
  std::vector<ScanAxis> out;
  for (const ScanAxis& axis : {ScanAxis{{"ef", 0.3, 0.7}, 0.1}, ScanAxis{{"edv", 80, 220}, 35}})
    if (!given.contains(axis.range.key)) out.push_back(axis);
  return out;
}

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
  const ScanPoint& best = grid.points[grid.best];
  out.hearts = static_cast<int>(grid.points.size()) + 1;
  out.values = best.values;
  out.found = discrepancy.searchAlsoFrom(family.at(best.values), {best.found.pose});
  if (!grid.minimum.empty()) {
    const PoseFound between = discrepancy.searchAlsoFrom(family.at(grid.minimum), {out.found.pose});
    ++out.hearts;
    if (between.discrepancy < out.found.discrepancy) {
      out.values = grid.minimum;
      out.found = between;
    }
  }
  if (tilt_deg > 0) {
    out.tilt = searchTilt([&](const PlaneTilt& tilt) { return family.at(out.values, tilt); },
                          discrepancy, out.found, tilt_deg, monitor);
    out.found = out.tilt->found;
  }
  out.claimed = claimedShare(family.at(out.values, out.tilt ? out.tilt->tilt : PlaneTilt{}),
                             discrepancy.stack(), out.found.pose);
  out.left = pictureLeft(out.found.discrepancy, out.claimed);
  return out;
}

}  // namespace echocine::compare
