#pragma once
// Overlays of a cine: depth ticks along the sector's edge and an ECG strip below it.

#include <cstdint>
#include <vector>

#include "signal/picture.h"

namespace echocine {

class Overlay {
 public:
  // ecg: lead amplitude (R wave = 1) at evenly spaced instants over the whole loop, first frame to
  // the end of the last; empty: no strip.
  Overlay(const Scene& scene, const PictureGeometry& geometry, const std::vector<double>& ecg);

  // Draws ticks, trace and the cursor at loop_position in [0, 1]. Thread-safe. Precondition: the
  // image has the size in the scene's output settings.
  void draw(GreyImage& image, double loop_position) const;

 private:
  struct Stroke {  // one pixel and its grey level
    int x, y;
    std::uint8_t grey;
  };

  int width_ = 0, height_ = 0;
  std::vector<Stroke> still_;
  std::vector<Stroke> dot_;     // of the cursor, relative to its centre
  std::vector<int> trace_row_;  // per column of the strip; empty without an ECG
  int first_column_ = 0, strip_top_ = 0;
};

}  // namespace echocine
