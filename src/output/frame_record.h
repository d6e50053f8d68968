#pragma once
// What the file writers need to know of one frame besides its images.

namespace echocine {

struct FrameRecord {
  int frame = 0;
  double time_s = 0;
  double phase = 0;
  int beat = 0;  // of the loop, from 0
};

}  // namespace echocine
