#pragma once
// An instant of a loop, and where in the cardiac cycle it is.

namespace echocine {

struct FrameTime {
  double time_s = 0;          // from the loop's start
  double phase = 0;           // of the keyframes, [0, 1), 0 at end-diastole (the R wave)
  int beat = 0;               // of the loop, from 0
  double time_in_beat_s = 0;  // from its R wave
  double beat_s = 0;          // from this beat's R wave to the next
  int frame = 0;              // of the loop, from 0; atTime() leaves it
};

}  // namespace echocine
