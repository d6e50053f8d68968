#pragma once
// Rows of contour clips for cell_echoes.cpp, one row per quantity, so that lanes are one load; and
// the angle that a part of a clip subtends at the transducer.

#include <array>
#include <cmath>
#include <cstdint>

#include "trace/edge_clips.h"
#include "trace/interface_lanes.h"

namespace echocine {

// Echoes of clips, and their positions. Along a clip `place` increases from place_a to place_b: the
// distance from the foot of the perpendicular from the centre; for a linear probe the depth from a.
struct EchoRows {
  ClipRow<double> strength;          // of a clip as if it filled the cell, per unit of angle
  ClipRow<double> whole;             // of the clip
  ClipRow<double> k_a, k_b;          // its ends, in samples; within one of the image
  ClipRow<std::int32_t> first, end;  // the samples it spans
  ClipRow<std::uint32_t> single;     // 1: a single one that contains the end of the clip; else 0
  ClipRow<double> zero_m, step_m;    // for sample k the nearer end is at zero + k step, as place
  ClipRow<double> exponent,
      exponent_step;  // A at the centre of the first sample, and its increment per sample
  ClipRow<double> place_a, place_b;
  ClipRow<double> p;     // distance of the foot from the centre; of a linear probe |dx / dz|
  ClipRow<double> flat;  // of a linear probe: |dx| of a clip without extent in depth
};

// Intervals of one sample on a clip each.
struct IntervalRows {
  static constexpr std::size_t kMost = 128;
  std::size_t count = 0;
  std::array<double, kMost> begin_m, end_m;  // as EchoRows::zero_m
  std::array<double, kMost> strength, place_a, place_b, p, flat;
};

// angle with 0 <= tan(angle) < 0.02 by three terms of the arctangent: to 1e-13.
inline constexpr double kSmallTangent = 0.02;
inline Doubles4 smallAngle(Doubles4 tangent) {
  const Doubles4 t2 = tangent * tangent;
  return tangent * (1 - t2 * (1.0 / 3 - t2 * (1.0 / 5)));
}

// Angle between two places on a line at the distance p from the centre, seen from there.
inline Doubles4 anglesBetween(Doubles4 begin, Doubles4 end, Doubles4 p) {
  const Doubles4 across = p * (end - begin), along = p * p + begin * end;
  const Doubles4 tangent = across / larger(along, kTiny);
  Doubles4 angle = smallAngle(tangent);
  const Mask4 wide = tangent >= kSmallTangent;
  if (!any(wide)) return angle;
  for (std::size_t j = 0; j < kDoubleLanes; ++j)
    if (wide[j]) angle[j] = std::atan2(across[j], along[j]);
  return angle;
}

}  // namespace echocine
