#include "motion/keyframes/motion_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "motion/keyframes/keyframe_pair.h"
#include "motion/mesh/surface_measure.h"

namespace echocine {

namespace {

// One gap's findings into the surface's.
void merge(const SurfaceBreaks& from, SurfaceBreaks& into) {
  if (from.first && (!into.first || from.first->frame < into.first->frame)) into.first = from.first;
  if (from.collapsed && (!into.collapsed || from.collapsed->share < into.collapsed->share))
    into.collapsed = from.collapsed;
  if (from.inside_out && (!into.inside_out || from.inside_out->frame < into.inside_out->frame))
    into.inside_out = from.inside_out;
  if (from.overshoot && (!into.overshoot ||
                         std::abs(from.overshoot->beyond_m3) > std::abs(into.overshoot->beyond_m3)))
    into.overshoot = from.overshoot;
}

// Frames grouped by the keyframe before them; frames at a keyframe are omitted.
std::vector<std::vector<FramePhase>> framesAfter(const KeyframeWeights& weights,
                                                 std::span<const FramePhase> frames) {
  std::vector<std::vector<FramePhase>> after(weights.keyframeCount());
  for (const FramePhase& frame : frames) {
    const std::pair<std::size_t, std::size_t> around = weights.around(frame.phase);
    if (around.first != around.second) after[around.first].push_back(frame);
  }
  return after;
}

}  // namespace

SurfaceBreaks findBreaks(const ControlMotion& motion, std::span<const FramePhase> frames) {
  SurfaceBreaks all;
  if (motion.still()) return all;
  const std::vector<std::vector<FramePhase>> after = framesAfter(motion.weights, frames);
  const std::vector<Neighbours> neighbours = neighboursOf(motion.triangles);
  std::vector<SurfaceBreaks> found(after.size());
  std::vector<std::vector<bool>> is_broken(after.size());
  parallelBlocks(after.size(), 1, [&](std::size_t gap, std::size_t) {
    if (after[gap].empty()) return;
    KeyframePair pair(motion, neighbours, gap, (gap + 1) % after.size());
    for (const FramePhase& frame : after[gap]) pair.look(frame, found[gap]);
    if (found[gap].first) is_broken[gap] = pair.isBroken();
  });
  std::vector<bool> anywhere(motion.triangles.size(), false);
  for (std::size_t gap = 0; gap < after.size(); ++gap) {
    merge(found[gap], all);
    for (std::size_t t = 0; t < is_broken[gap].size(); ++t)
      if (is_broken[gap][t]) anywhere[t] = true;
  }
  all.triangles = static_cast<std::size_t>(std::count(anywhere.begin(), anywhere.end(), true));
  return all;
}

// Volumes far above zero decide; only others need the exact check.
std::optional<SurfaceBreaks::Size> findInsideOut(const ControlMotion& motion,
                                                 std::span<const FramePhase> frames) {
  if (motion.still() || motion.membrane) return std::nullopt;
  const VolumeSum volume(motion.triangles);
  std::vector<Vec3f> positions_m;
  double least_m3 = std::numeric_limits<double>::infinity(), most_m3 = 0;
  for (const FramePhase& frame : frames) {
    motion.at(frame.phase, positions_m);
    const double volume_m3 = volume.of(positions_m);
    if (!(volume_m3 >= least_m3)) least_m3 = volume_m3;  // also takes NaN
    most_m3 = std::max(most_m3, volume_m3);
  }
  constexpr double kFarAbove = 1e-6;
  if (least_m3 > kFarAbove * most_m3) return std::nullopt;
  return findBreaks(motion, frames).inside_out;
}

}  // namespace echocine
