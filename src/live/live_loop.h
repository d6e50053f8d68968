#pragma once
// The loop of a session as one file for slides.

#include <cstddef>
#include <functional>
#include <vector>

#include "signal/picture.h"
#include "video/animation.h"

namespace echocine::live {

// Encodes a loop of `frames` frames at `rate_hz`, which `frame` gives by their numbers. Above the
// rate that the format's players keep up with, frames are left out and the duration stays. The
// picture is cropped to even sides. Throws JobError, SceneError for over kMostLoopFrames frames,
// and what `frame` throws.
inline constexpr int kMostLoopFrames = 3000;
std::vector<std::byte> encodeLoop(AnimationFormat format, int frames, double rate_hz,
                                  const std::function<GreyImage(int)>& frame);

}  // namespace echocine::live
