#pragma once
// Frames traced for the measurement of white, kept so that they are not traced again.

#include <cstddef>
#include <map>
#include <mutex>
#include <utility>

#include "motion/surfaces/volumes.h"
#include "trace/polar_frame.h"

namespace echocine {

// Our choice: loops of one beat are kept completely at usual sizes, and memory is bounded for long
// ones.
inline constexpr std::size_t kKeptBytes = 128u << 20;

class KeptFrames {
 public:
  // Keeps frames of the range only, as long as there is room; of long loops the first ones.
  explicit KeptFrames(std::pair<int, int> range) : range_(range) {}

  void keep(int frame, PolarFrame&& polar, Volumes&& volumes_ml);

  // Releases a frame, once; false if it was not kept. Thread-safe.
  bool take(int frame, PolarFrame& polar, Volumes& volumes_ml);

 private:
  struct Kept {
    PolarFrame polar;
    Volumes volumes_ml;
  };
  const std::pair<int, int> range_;
  std::size_t bytes_ = 0;
  std::mutex mutex_;
  std::map<int, Kept> frames_;
};

}  // namespace echocine
