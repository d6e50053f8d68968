#pragma once
// The frames that determine a loop's white: one list for a frame in memory and for a loop of files.

#include <vector>

namespace echocine {

// Our choice: more frames hardly change the percentile, and a single frame of a long loop need not
// trace all others.
inline constexpr int kReferenceFrames = 64;

// Frame numbers in ascending order: all frames of a loop of up to kReferenceFrames, otherwise that
// many spread over it. Slightly longer loops repeat some frames. The numbers depend on the count
// only.
std::vector<int> referenceFrames(int frame_count);

}  // namespace echocine
