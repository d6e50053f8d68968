#pragma once
// The pixels of a loop that show echoes: those ever brighter than the background.

#include "video/video.h"

namespace echocine::echo {

struct EchoPixels {
  int width = 0, height = 0;
  PixelPlane live;     // 1 inside
  PixelPlane highest;  // largest grey over the loop
  PixelPlane range;    // largest minus smallest

  bool at(int x, int y) const {
    return x >= 0 && y >= 0 && x < width && y < height &&
           live[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(x)] != 0;
  }
};

// Live pixels change by more than `moving` grey levels over the loop, or are brighter than the
// background by at least twice that, and belong to the largest connected part after an opening by
// one pixel, which removes attached text and ticks.
EchoPixels echoPixels(const Video& video, int moving);

}  // namespace echocine::echo
