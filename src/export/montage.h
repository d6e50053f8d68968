#pragma once
// Several loops side by side in one picture.

#include <cstddef>
#include <filesystem>
#include <memory>
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
// beat stay in phase. Only one of several loops is in memory: the scaled frames lie in a file
// without a name, which vanishes with the montage or the process.
class Montage {
 public:
  // A grid for `count` loops; at least one. Cells have the shape of the first loop and `cell_width`
  // pixels (0: the first loop's width); columns 0: a nearly square grid. `scratch`: folder of the
  // file.
  Montage(std::size_t count, int columns, int cell_width, std::filesystem::path scratch);
  ~Montage();
  Montage(const Montage&) = delete;
  Montage& operator=(const Montage&) = delete;

  // The next loop. Throws SceneError for a picture of over 8192 pixels a side; JobError if the
  // frames cannot be kept.
  void add(MontageLoop loop);

  int width() const { return width_; }  // even, as MP4 requires; known after the first loop
  int height() const { return height_; }

  // The picture at a phase of 0 to 1, exclusive, of the first loop. Precondition: all loops are
  // added. Throws JobError.
  GreyImage at(double phase) const;

 private:
  class Store;
  struct Cell {
    std::string caption;
    int width = 0, height = 0;  // of its scaled frames
    std::size_t frames = 0, first_byte = 0;
  };
  void layOut(const GreyImage& first);
  GreyImage frameOf(const Cell& cell, std::size_t n) const;

  std::size_t count_;
  int columns_, cell_width_, cell_height_ = 0, width_ = 0, height_ = 0;
  std::unique_ptr<Store> store_;
  std::vector<Cell> cells_;
  std::vector<GreyImage> last_;  // frames of the last loop, which stay in memory
};

}  // namespace echocine
