#pragma once
// What a box of a loop in beam space looks like, and how long its speckle lasts: measured alike on
// real and on simulated loops.

#include <span>

#include "metrics/block_match.h"

namespace echocine {

// Lines and samples, ends included.
struct EchoBox {
  int first_line = 0, last_line = 0, first_sample = 0, last_sample = 0;
};

inline constexpr int kEchoLags = 5;  // frames

// NaN where nothing could be measured.
struct BoxEcho {
  double mean = 0, deviation = 0;  // of grey, in the frame that the box was placed in
  // Full width at half maximum of the grey's autocovariance about its mean, along a line and across
  // lines. Between whole lags linearly.
  double axial_samples = 0, lateral_lines = 0;
  // Correlation of the box with itself 1 to 5 frames later, a mean over the loop: where block
  // matching finds it again, and in the same place. The box follows the tissue from frame to frame.
  double tracked[kEchoLags] = {}, in_place[kEchoLags] = {};
};

// `frames` are of one size; `reach` is how far a block is searched for from one frame to the next,
// twice as far in two. Throws nothing. Preconditions: the box lies within the frames and has at
// least 3 lines and samples; 0 <= placed < frames.size().
BoxEcho boxEcho(std::span<const BlockPlane> frames, const EchoBox& box, std::size_t placed,
                const BlockMatchSettings& reach);

}  // namespace echocine
