#pragma once
// Appearance of a box of a loop in beam space, and persistence of its speckle: the same measurement
// for real and simulated loops.

#include <span>

#include "metrics/block_match.h"

namespace echocine {

// Lines and samples, ends included.
struct EchoBox {
  int first_line = 0, last_line = 0, first_sample = 0, last_sample = 0;
};

inline constexpr int kEchoLags = 5;  // frames

// NaN if not measurable.
struct BoxEcho {
  double mean = 0, deviation = 0;  // of the grey level, in the frame of the box
  // Full width at half maximum of the grey level's autocovariance about its mean, along a line and
  // across lines. Linear between whole lags.
  double axial_samples = 0, lateral_lines = 0;
  // Correlation of the box with itself 1 to 5 frames later, mean over the loop: at its best match,
  // and at the same place. The box follows the tissue from frame to frame.
  double tracked[kEchoLags] = {}, in_place[kEchoLags] = {};
};

// `frames` are of one size; `reach` is the search range between successive frames, twice as large
// over two. Throws nothing. Preconditions: the box is within the frames and has at least 3 lines
// and samples; 0 <= placed < frames.size().
BoxEcho boxEcho(std::span<const BlockPlane> frames, const EchoBox& box, std::size_t placed,
                const BlockMatchSettings& reach);

}  // namespace echocine
