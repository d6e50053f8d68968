#pragma once
// The first pass of a loop: its one reference for log compression.

#include <map>
#include <optional>

#include "frame/simulator.h"
#include "render/render.h"

namespace echocine {

// Our choice: loops of a beat are kept whole at usual sizes, and long ones stay bounded.
inline constexpr std::size_t kKeptBytes = 128u << 20;

// Frames that were traced while the reference was sought and need not be traced again.
struct KeptFrame {
  PolarFrame polar;
  Volumes volumes_ml;
};
using KeptFrames = std::map<int, KeptFrame>;

// The scene's absolute reference at once, or the percentile over referenceFrames() of the loop: the
// same whichever are rendered, so that parts of a loop show the same grey as the whole. Frames of
// `range` met on the way are kept, as many as kKeptBytes hold. Nothing when the monitor stops the
// run. Where no frame has anything to be seen the percentile would paint an even nothing white;
// then the reference is the transmitted intensity, 1, and the loop is black.
std::optional<double> findReference(const Simulator& simulator, std::pair<int, int> range,
                                    const Monitor& monitor, KeptFrames& kept);

}  // namespace echocine
