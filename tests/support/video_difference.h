#pragma once
// Largest difference of grey levels between two videos.

#include <algorithm>
#include <cstdlib>

#include "video/read_video.h"

namespace echocine::support {

// 256 if they differ in size or number of frames.
inline int worstDifference(const Video& a, const Video& b) {
  if (a.frameCount() != b.frameCount() || a.width != b.width || a.height != b.height) return 256;
  int worst = 0;
  for (std::size_t f = 0; f < a.frames.size(); ++f)
    for (std::size_t p = 0; p < a.frames[f].size(); ++p)
      worst = std::max(worst, std::abs(a.frames[f][p] - b.frames[f][p]));
  return worst;
}

}  // namespace echocine::support
