#pragma once
// Limits that reading a scene and reading back its frames share; our choice.

namespace echocine {

// Most lines x samples of a frame.
inline constexpr double kMaxPolarSamples = 1 << 26;

}  // namespace echocine
