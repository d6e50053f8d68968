#pragma once
// Limits shared by the scene reader and the reader of frames; our choice.

namespace echocine {

// Largest lines x samples of a frame.
inline constexpr double kMaxPolarSamples = 1 << 26;

}  // namespace echocine
