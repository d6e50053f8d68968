#pragma once
// Frames that were traced while white was measured and need not be traced again.

#include <cstddef>
#include <map>
#include <mutex>
#include <utility>

#include "motion/volumes.h"
#include "trace/polar_frame.h"

namespace echocine {

// Our choice: loops of a beat are kept whole at usual sizes, and long ones stay bounded.
inline constexpr std::size_t kKeptBytes = 128u << 20;

class KeptFrames {
 public:
  // Keeps frames of the range alone, as long as there is room: loops of a beat whole at usual
  // sizes, of long ones the first.
  explicit KeptFrames(std::pair<int, int> range) : range_(range) {}

  void keep(int frame, PolarFrame&& polar, Volumes&& volumes_ml);

  // Gives a frame away, once; false where it was not kept. Thread-safe.
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
