#pragma once
// The pictures of a comparison: real, synthetic and their difference side by side, in one geometry.

#include <filesystem>
#include <span>
#include <vector>

#include "compare/compare.h"

namespace echocine::compare {

class BoundaryBands;

enum class Panel { real, synthetic, difference };

// Pictures in the common sector, scan-converted from the registered loops. The synthetic one is
// calibrated. The difference is 128 + (synthetic - real) / 2.
class PanelMaker {
 public:
  PanelMaker(const Comparison& comparison, int height_px = 480);

  int width() const { return width_; }
  int height() const { return height_; }
  GreyImage picture(Panel panel, int real_frame) const;
  // From left to right. Precondition: one or more, all of one size.
  static GreyImage sideBySide(std::span<const GreyImage> pictures);

  // Draws the model's contours into the first two pictures. Precondition: `bands` outlives the
  // maker.
  void drawContours(const BoundaryBands* bands) { bands_ = bands; }

 private:
  struct Pixel {
    int at;              // in the picture
    float line, sample;  // in beam space
  };
  void addContours(int real_frame, GreyImage& image) const;

  const Comparison& c_;
  int width_ = 0, height_ = 0;
  double pixels_per_unit_ = 1, left_ = 0, top_ = 0;
  std::vector<Pixel> pixels_;
  const BoundaryBands* bands_ = nullptr;
};

// A frame with the detected (or given) sector and the mask drawn over it, for inspection.
GreyImage sectorPicture(const echo::EchoLoop& loop);

}  // namespace echocine::compare
