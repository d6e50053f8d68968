#pragma once
// Averaging over time by the scanner: pictures that keep a part of the previous one.

#include <optional>

#include "echo/echo_loop.h"

namespace echocine::echo {

// (26)  r = (D_2 - D_1) / D_1,   p = r for r < 0.4, else max(0.4, 0.64 r); 0 to 0.8
// D_k: mean square difference of the grain of two pictures, k frames apart, in a block of the
// sector; r: 10 % quantile over the blocks. p: share of the previous picture in a picture,
// y_n = p y_(n-1) + (1 - p) x_n. If x_n is unrelated noise, D_k is proportional to 1 - p^k, so
// r = p. Grain of tissue moves, which adds to r: 0.64 is our choice, by planted loops of six looks
// with p of 0, 0.35, 0.5 and 0.8, whose r were 0.03 to 0.07, 0.28 to 0.40, 0.55 to 0.95 and 1.08 to
// 1.40 (20 and 25 frames a beat). None with fewer than 20 blocks or six pairs of frames; frames
// that repeat the previous one are left out.
std::optional<double> persistenceOf(const EchoLoop& loop);

// Mean age of a picture's content, in frames: p / (1 - p).
inline double lagFrames(double persistence) {
  return persistence / (1 - persistence);
}

}  // namespace echocine::echo
