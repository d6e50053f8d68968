#pragma once
// When each frame is taken, and where in the cardiac cycle that is.

#include <optional>
#include <vector>

#include "motion/cycle/frame_time.h"
#include "motion/cycle/time_warp.h"
#include "scene/scene.h"

namespace echocine {

class CardiacClock {
 public:
  explicit CardiacClock(const Scene& scene) : CardiacClock(scene.acquisition, scene.motion) {}
  explicit CardiacClock(const Acquisition& acquisition, const MotionSettings& motion = {});

  // Frames of the loop: the beats' duration in frame intervals, rounded to whole frames, at
  // least 1.
  int frameCount() const;
  FrameTime at(int frame) const;
  // Any instant from half a frame's interval before the loop's first frame to the end of its last.
  // Precondition: in that range.
  FrameTime atTime(double time_s) const;

 private:
  double duration() const;  // of the loop's beats, s
  FrameTime inSteadyBeats(double time_s, double cycles) const;
  FrameTime inVariedBeats(double time_s) const;

  Acquisition acquisition_;
  std::optional<RecordedBeat> recorded_;  // set where keyframes have to be warped
  std::optional<TimeWarp> steady_warp_;   // of every beat where all are alike
  std::vector<double> starts_s_;          // of each beat; empty where all are alike
};

}  // namespace echocine
