#pragma once
// The pixels of a loop that show echoes: those that are ever brighter than the background.

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

// Live: moving by more than `moving` grey levels over the loop, or brighter than the background by
// twice that and more, and in the largest connected part once pixels are thinned and thickened by
// one (so that text and ticks that only touch fall off).
EchoPixels echoPixels(const Video& video, int moving);

}  // namespace echocine::echo
