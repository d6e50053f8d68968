#pragma once
// Lines acquired one after the other.
//
// Line l of N is acquired at t + ((l + 1/2) / N - 1/2) s T. t is the frame's time (that of its
// middle), T the frame interval, and s the share of T in which lines are acquired. Groups of
// accuracy.rolling_lines neighbours share the instant of their middle. A line of a rolling frame
// equals the same line of a still frame at its group's instant.

#include <cstdint>
#include <functional>
#include <vector>

#include "core/beam_plane.h"
#include "scene/scene.h"
#include "trace/polar_frame.h"
#include "trace/trace_frame.h"
#include "truth/frame_truth.h"

namespace echocine {

// Lines acquired at one instant, and what must be traced for them.
struct LineGroup {
  LineRange lines;
  double offset_s = 0;     // from the frame's time
  NeededSamples traced{};  // for these lines
  LineRange beams{};       // that hold all these samples
};

// The group of some lines. taken: the samples of each line that these lines need.
LineGroup lineGroup(LineRange lines, double offset_s, std::vector<int> taken);

class RollingLines {
 public:
  // taken: the samples of each line that some lines need.
  RollingLines(const Scene& scene, const std::function<std::vector<int>(LineRange)>& taken);

  using Group = LineGroup;
  const std::vector<Group>& groups() const { return groups_; }

  // Copies the lines of a group, for all existing planes. `to` has room after the first.
  void take(std::size_t group, const PolarFrame& from, PolarFrame& to) const;
  // The same for truth, at samples and at the pixels nearest to its lines.
  void take(std::size_t group, const FrameTruth& from, FrameTruth& to) const;

 private:
  int lines_, samples_;
  std::vector<Group> groups_;
  std::vector<std::uint16_t> group_of_pixel_;  // of the picture; only with labels
};

}  // namespace echocine
