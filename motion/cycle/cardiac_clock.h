#pragma once
// Time and cardiac phase of each frame.

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

  // Number of frames: the duration of the beats in frame intervals, rounded, at least 1.
  int frameCount() const;
  FrameTime at(int frame) const;
  // Any instant from half a frame interval before the first frame to the end of the last.
  // Precondition: in that range.
  FrameTime atTime(double time_s) const;

 private:
  double duration() const;  // of the loop's beats, s
  FrameTime inSteadyBeats(double time_s, double cycles) const;
  FrameTime inVariedBeats(double time_s) const;

  Acquisition acquisition_;
  std::optional<RecordedBeat> recorded_;  // set if keyframes are warped
  std::optional<TimeWarp> steady_warp_;   // of every beat, if all are equal
  std::vector<double> starts_s_;          // of each beat; empty if all are equal
};

}  // namespace echocine
