#include "echo/frame_blend.h"

#include <algorithm>
#include <cmath>

namespace echocine::echo {

Blend blendAt(double place, int frames, double beat, bool periodic) {
  if (periodic) {
    place -= beat * std::floor(place / beat);
    const int last = std::min(frames - 1, static_cast<int>(std::ceil(beat)) - 1);
    if (place >= last) {
      const double share = (place - last) / std::max(1e-9, beat - last);
      return {static_cast<std::size_t>(last), 0, std::clamp(share, 0.0, 1.0), true};
    }
  }
  if (place < -1e-9 || place > frames - 1 + 1e-9) return {};
  const int a = std::clamp(static_cast<int>(std::floor(place)), 0, std::max(0, frames - 2));
  return {static_cast<std::size_t>(a), static_cast<std::size_t>(std::min(a + 1, frames - 1)),
          std::clamp(place - a, 0.0, 1.0), true};
}

// A blend of two frames smears what moves by less than a frame; the error is that of the frame rate
// itself.
std::vector<float> frameAtPlace(const std::vector<std::vector<float>>& frames, double place,
                                double beat, bool periodic) {
  const Blend blend = blendAt(place, static_cast<int>(frames.size()), beat, periodic);
  const auto share = static_cast<float>(blend.share);
  std::vector<float> out(frames[blend.a].size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = (1 - share) * frames[blend.a][i] + share * frames[blend.b][i];
  return out;
}

}  // namespace echocine::echo
