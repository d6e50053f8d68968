#pragma once
// The timed stages of a frame.

#include <array>
#include <cstddef>

namespace echocine {

// In the manifest's order.
enum class Stage { motion, geometry, trace, speckle, signal, scan_conversion, truth, exr, avi };
inline constexpr std::size_t kStages = 9;

constexpr const char* stageName(Stage stage) {
  constexpr std::array<const char*, kStages> kNames{
      "motion", "geometry", "trace", "speckle", "signal", "scan_conversion", "truth", "exr", "avi"};
  return kNames[static_cast<std::size_t>(stage)];
}

}  // namespace echocine
