// Frames whose lines have instants of their own, and still ones of the same scene.

#include <utility>

#include "frame/simulator.h"

namespace echocine {

// Near the probe the average over the beam takes in nearly all lines, deeper few of them; haze
// takes in all. What only a group's lines need is done for these alone.
WorkCounts Simulator::traceRolling(const FrameTime& time, Workspace& w) const {
  WorkCounts work;
  for (std::size_t g = 0; g < rolling_->groups().size(); ++g) {
    const RollingLines::Group& group = rolling_->groups()[g];
    const FrameTime at = timeOf(time.time_s + group.offset_s);
    stand(at, w);
    work += traceAt(at, &group, w);
    if (request_.intensities) processAt(at, group.lines, w);
    rolling_->take(g, w.polar, w.rolled);
  }
  std::swap(w.polar, w.rolled);
  return work;
}

Volumes Simulator::traceStill(const FrameTime& time, Workspace& w) const {
  if (w.polar.intensities.empty()) w.polar.intensities = Intensities(w.greys.release());
  stand(time, w);
  count(traceAt(time, nullptr, w));
  if (request_.intensities) processAt(time, all_lines_, w);
  return clock_.time(Stage::motion, [&] { return volumes(w.surfaces); });
}

}  // namespace echocine
