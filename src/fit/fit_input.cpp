#include "fit/fit_input.h"

#include <fmt/format.h>

#include "core/error.h"

namespace echocine::fit {

double motionOf(const echo::EchoLoop& loop) {
  const auto frames = static_cast<double>(loop.video.frames.size());
  double pixels = 0, sum = 0, square = 0, over_time = 0;
  for (int y = 0; y < loop.video.height; ++y)
    for (int x = 0; x < loop.video.width; ++x) {
      const auto p = static_cast<std::size_t>(y * loop.video.width + x);
      if (!loop.sector().contains(x + 0.5, y + 0.5) || loop.overlay[p] != 0) continue;
      double mean = 0, own = 0;
      for (const PixelPlane& frame : loop.video.frames) {
        mean += frame[p] / frames;
        own += static_cast<double>(frame[p]) * frame[p] / frames;
      }
      ++pixels;
      sum += mean;
      square += mean * mean;
      over_time += own - mean * mean;
    }
  if (!(pixels > 0)) return 0;
  const double over_picture = square - sum * sum / pixels;
  return over_picture > 0 ? over_time / over_picture : 0;
}

void checkMoves(const FitLoop& one) {
  if (motionOf(one.loop) < kLeastMotion)
    throw SceneError(fmt::format("{}: {}: the pictures do not change: give a loop of a whole beat",
                                 keyOf(one.view), one.loop.video.name));
}

std::vector<std::string> notesOf(const FitLoop& one) {
  std::vector<std::string> out;
  for (const std::string& note : one.loop.video.notes)
    out.push_back(fmt::format("{}: {}", keyOf(one.view), note));
  return out;
}

}  // namespace echocine::fit
