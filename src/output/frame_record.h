#pragma once
// What the file writers need to know of one frame besides its images.

#include <span>
#include <string>

#include "scene/scene.h"

namespace echocine {

struct FrameRecord {
  int frame = 0;
  double time_s = 0;
  double phase = 0;
  int beat = 0;  // of the loop, from 0
};

// One plane of a polar frame: line-major (all samples of line 0, then of line 1, ...), shallow to
// deep. Exactly one of the spans is set.
struct ChannelPlane {
  Channel channel;
  std::span<const float> values;
  std::span<const std::uint32_t> ids;  // whole numbers: isLabel(channel)
};

}  // namespace echocine
