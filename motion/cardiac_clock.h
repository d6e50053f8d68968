#pragma once
// When each frame is taken, and where in the cardiac cycle that is.

#include "scene/scene.h"

namespace echocine {

struct FrameTime {
  double time_s = 0;
  double phase = 0;  // [0, 1), 0 at end-diastole (the R wave)
};

class CardiacClock {
 public:
  explicit CardiacClock(const Acquisition& acquisition) : acquisition_(acquisition) {}

  // Frames of the loop: the beats' duration in frame intervals, rounded to whole frames, at
  // least 1.
  int frameCount() const;
  FrameTime at(int frame) const;

 private:
  Acquisition acquisition_;
};

}  // namespace echocine
