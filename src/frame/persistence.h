#pragma once
// Persistence: what is shown is a weighted mean of the greys of a frame and of those before it.

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "core/beam_plane.h"
#include "motion/cycle/cardiac_clock.h"

namespace echocine {

// A scanner's recursion grey_n = (1 - p) new_n + p grey_(n-1) never forgets; here its weights p^j
// end where they fall under 1/64 and are divided by their sum. So a frame depends on few others,
// and any frame alone has the bytes that it has in its loop. Before the loop's first frame there is
// none: fewer are then averaged.
class Persistence {
 public:
  // weight: p, over 0 and under 1.
  Persistence(double weight, const CardiacClock& clock, double frame_rate_hz);

  // Frames before the shown one that still count.
  int depth() const { return static_cast<int>(weights_.size()) - 1; }

  // In place. `alone` gives the greys of an earlier instant without persistence; those of the
  // loop's frames are kept for a while. Thread-safe.
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
  mutable double reference_ = 0;      // of the kept ones
  mutable std::map<int, Kept> kept_;  // by frame of the loop
};

}  // namespace echocine
