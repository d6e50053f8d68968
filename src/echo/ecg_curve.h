#pragma once
// A thin curve in a band of a picture, outside its sector: where an ECG is drawn.

#include <vector>

#include "echo/sector.h"

namespace echocine::echo {

// Columns of a picture that hold the curve, and rows that it keeps to; ends included.
struct CurveBand {
  int left = 0, right = 0, top = 0, bottom = 0;
  int columns() const { return right - left + 1; }
  int rows() const { return bottom - top + 1; }
};

// Columns that changed from a frame to the next; ends included, counted from the band's left.
struct ChangedColumns {
  int first = 0, last = 0;
  int pixels = 0;
  int width() const { return last - first + 1; }
};

// A band's curve in every frame.
struct EcgCurve {
  CurveBand band;
  double thickness_px = 1;
  // By frame and column: how far the curve lies above its usual row, px; NaN where there is none.
  std::vector<std::vector<float>> height_px;
  // By frame: what changed since the frame before; the most pixels first, eight at most.
  std::vector<std::vector<ChangedColumns>> changed;
};

// Bands that hold a curve in a third of the frames and more, the widest first, three at most. A
// curve is brighter than what is around it, at least 0.15 of the picture's width long, at most 0.35
// of its height high, 8-connected once gaps of two pixels are closed, thin, and single-valued: one
// run of pixels in four of five columns. Text, bars and ticks that stand free are none of these.
// Our choice of numbers.
std::vector<CurveBand> curveBands(const Video& video, const Sector& sector);

EcgCurve curveIn(const CurveBand& band, const Video& video, const Sector& sector);

}  // namespace echocine::echo
