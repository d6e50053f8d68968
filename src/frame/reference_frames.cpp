#include "frame/reference_frames.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echocine {

// One frame of each of kReferenceFrames equal parts of the loop, at a place that moves on by the
// golden section, so that beats as long as a part are not met at one phase alone.
std::vector<int> referenceFrames(int frame_count) {
  std::vector<int> sampled;
  const int parts = std::min(frame_count, kReferenceFrames);
  for (int k = 0; k < parts; ++k) {
    double whole = 0;
    const double within = frame_count == parts ? 0 : std::modf(k * std::numbers::phi, &whole);
    sampled.push_back(static_cast<int>((k + within) * frame_count / parts));
  }
  return sampled;
}

}  // namespace echocine
