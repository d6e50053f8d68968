#pragma once
// A loop interpolated between two of its frames.

#include <cstddef>
#include <vector>

namespace echocine::echo {

// Two neighbouring frames and the weight of the second.
struct Blend {
  std::size_t a = 0, b = 0;
  double share = 0;     // 0..1
  bool inside = false;  // false: outside the loop
};

// place and beat in frames; beat 0: not periodic. A periodic loop closes from the last frame before
// the beat's end to frame 0; that step may be shorter or longer than one frame.
Blend blendAt(double place, int frames, double beat, bool periodic);

// Interpolated frame at a place, for loops in beam space.
std::vector<float> frameAtPlace(const std::vector<std::vector<float>>& frames, double place,
                                double beat, bool periodic);

}  // namespace echocine::echo
