#pragma once
// A channel of a frame, for file writers and callers.

#include <cstdint>
#include <span>

#include "scene/scene.h"

namespace echocine {

// One plane of a polar frame: line-major (all samples of line 0, then of line 1, ...), shallow to
// deep. Exactly one of the spans is set.
struct ChannelPlane {
  Channel channel;
  std::span<const float> values;
  std::span<const std::uint32_t> ids;  // whole numbers: isLabel(channel)
};

}  // namespace echocine
