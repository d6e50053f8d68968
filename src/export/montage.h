#pragma once
// Several loops side by side in one picture.

#include <string>
#include <vector>

#include "signal/picture.h"

namespace echocine {

// One loop of a montage. All frames have the same size.
struct MontageLoop {
  std::string caption;  // empty: none
  std::vector<GreyImage> frames;
  double duration_s = 0;
};

// A grid of equal cells, filled by rows. Loops are scaled to the cell, keeping their shape, and
// centred on black. Loops of different duration are stretched to the first one's, so loops of one
// beat stay in phase.
class Montage {
 public:
  // Cells have the shape of the first loop and `cell_width` pixels (0: the first loop's width);
  // columns 0: a nearly square grid. Throws SceneError for a picture of over 8192 pixels a side.
  Montage(std::vector<MontageLoop> loops, int columns, int cell_width);

  int width() const { return width_; }  // even, as MP4 requires
  int height() const { return height_; }

  // The picture at a phase of 0 to 1, exclusive, of the first loop.
  GreyImage at(double phase) const;

 private:
  std::vector<MontageLoop> loops_;
  int columns_ = 1, cell_width_ = 0, cell_height_ = 0, width_ = 0, height_ = 0;
};

}  // namespace echocine
