#pragma once
// The frames of a loop by which its white is measured: one list for a frame in memory and for a
// loop of files.

#include <vector>

namespace echocine {

// Our choice: the percentile of a beat's frames hardly moves with more, and a single frame of a
// long loop need not trace the whole of it.
inline constexpr int kReferenceFrames = 64;

// Frame numbers, in order: all of a loop of up to kReferenceFrames, else that many spread over it,
// some of them twice in a loop hardly longer. They follow from the count alone.
std::vector<int> referenceFrames(int frame_count);

}  // namespace echocine
