#pragma once
// Persistence: the displayed grey levels are a weighted mean of a frame and its predecessors.

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "core/beam_plane.h"
#include "motion/cycle/cardiac_clock.h"

namespace echocine {

// A scanner's recursion grey_n = (1 - p) new_n + p grey_(n-1) has infinite memory. Here the weights
// p^j end below 1/64 and are normalised, so a frame depends on few others, and a single frame has
// the bytes of the loop's. Frames before the start of the loop do not exist; fewer are averaged
// there.
class Persistence {
 public:
  // weight: p, over 0 and under 1.
  Persistence(double weight, const CardiacClock& clock, double frame_rate_hz);

  // Number of previous frames with weight.
  int depth() const { return static_cast<int>(weights_.size()) - 1; }

  // In place. `alone` returns the grey levels of an earlier instant without persistence; those of
  // the loop's frames are cached. Thread-safe.
  using Alone = std::function<Greys(const FrameTime&)>;
  void apply(double reference_intensity, const FrameTime& time, Greys& greys,
             const Alone& alone) const;

 private:
  using Kept = std::shared_ptr<const Greys>;
  Kept known(double reference_intensity, int frame) const;
  void keep(double reference_intensity, int frame, Kept greys) const;
  std::vector<FrameTime> before(const FrameTime& time) const;
  bool ofLoop(const FrameTime& time) const;

  std::vector<float> weights_;  // of the frame itself, the one before, ...
  const CardiacClock& clock_;
  double frame_rate_hz_;
  mutable std::mutex mutex_;
  mutable double reference_ = 0;      // white of the cached frames
  mutable std::map<int, Kept> kept_;  // by frame of the loop
};

}  // namespace echocine
