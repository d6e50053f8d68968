#pragma once
// Downsampling of pictures by exact averages over pixels.

#include "signal/picture.h"

namespace echocine::dataset {

// A square of a picture: its upper left corner and its side, in pixels.
struct Square {
  double x = 0, y = 0, side = 0;
};

// The bounding square of the sector in a square picture (signal/picture.h has its margins).
Square sectorSquare(const GreyImage& image);

// to x to pixels, exact averages over the square. Precondition: the square is within the picture.
GreyImage shrunk(const GreyImage& image, const Square& from, int to);

// A place of the large picture in the small one; the centre of pixel (0, 0) is (0, 0).
PixelPoint inShrunk(PixelPoint at, const Square& from, int to);

}  // namespace echocine::dataset
