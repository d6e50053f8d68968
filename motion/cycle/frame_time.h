#pragma once
// An instant of a loop, and its position in the cardiac cycle.

namespace echocine {

struct FrameTime {
  double time_s = 0;          // from the loop's start
  double phase = 0;           // of the keyframes, [0, 1), 0 at end-diastole (the R wave)
  int beat = 0;               // of the loop, from 0
  double time_in_beat_s = 0;  // from its R wave
  double beat_s = 0;          // duration of this beat, R wave to R wave
  int frame = 0;              // of the loop, from 0; atTime() does not set it
};

}  // namespace echocine
