#pragma once
// Data of one frame for the file writers, besides its images.

namespace echocine {

struct FrameRecord {
  int frame = 0;
  double time_s = 0;
  double phase = 0;
  int beat = 0;  // of the loop, from 0
};

}  // namespace echocine
