#pragma once
// A thin curve in a band of a picture outside its sector: a candidate for an ECG.

#include <vector>

#include "echo/sector.h"

namespace echocine::echo {

// Columns and rows of the curve in a picture; ends included.
struct CurveBand {
  int left = 0, right = 0, top = 0, bottom = 0;
  int columns() const { return right - left + 1; }
  int rows() const { return bottom - top + 1; }
};

// Columns that changed between two frames; ends included, counted from the band's left.
struct ChangedColumns {
  int first = 0, last = 0;
  int pixels = 0;
  int width() const { return last - first + 1; }
};

// A band's curve in every frame.
struct EcgCurve {
  CurveBand band;
  double thickness_px = 1;
  // By frame and column: height of the curve above its usual row, px; NaN without a curve.
  std::vector<std::vector<float>> height_px;
  // By frame: changed columns since the previous frame, the largest changes first, eight at most.
  std::vector<std::vector<ChangedColumns>> changed;
};

// Bands that contain a curve in at least a third of the frames, the widest first, three at most. A
// curve is brighter than its neighbourhood, at least 0.15 of the picture's width long, at most 0.35
// of its height high, 8-connected after closing gaps of two pixels, thin, and single-valued: one
// run of pixels in four of five columns. Isolated text, bars and ticks do not qualify. The numbers
// are our choice.
std::vector<CurveBand> curveBands(const Video& video, const Sector& sector);

EcgCurve curveIn(const CurveBand& band, const Video& video, const Sector& sector);

}  // namespace echocine::echo
