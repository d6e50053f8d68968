#pragma once
// Counted work of a run. A disabled effect costs nothing, and the counts show it.

#include <cstdint>

namespace echocine {

struct WorkCounts {
  std::uint64_t bvh_updates = 0;
  std::uint64_t facets_sliced = 0;
  std::uint64_t rays = 0;  // straight segments of scan lines
  std::uint64_t crossings = 0;
  std::uint64_t samples_backscatter = 0;  // samples whose backscatter was evaluated
  std::uint64_t samples_attenuated = 0;   // samples whose attenuation was evaluated

  WorkCounts& operator+=(const WorkCounts& other) {
    bvh_updates += other.bvh_updates;
    facets_sliced += other.facets_sliced;
    rays += other.rays;
    crossings += other.crossings;
    samples_backscatter += other.samples_backscatter;
    samples_attenuated += other.samples_attenuated;
    return *this;
  }
};

}  // namespace echocine
