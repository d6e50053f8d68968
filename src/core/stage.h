#pragma once
// The stages of a frame by which time is counted.

#include <array>
#include <cstddef>

namespace echocine {

// The stages that are timed, in the manifest's order.
enum class Stage { motion, geometry, trace, speckle, signal, scan_conversion, truth, exr, avi };
inline constexpr std::size_t kStages = 9;

constexpr const char* stageName(Stage stage) {
  constexpr std::array<const char*, kStages> kNames{
      "motion", "geometry", "trace", "speckle", "signal", "scan_conversion", "truth", "exr", "avi"};
  return kNames[static_cast<std::size_t>(stage)];
}

}  // namespace echocine
