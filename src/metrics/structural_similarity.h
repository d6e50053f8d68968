#pragma once
// Structural similarity of two pictures within an area.

#include <optional>
#include <span>

namespace echocine {

// Mean structural similarity: Wang, Bovik, Sheikh and Simoncelli, "Image quality assessment: from
// error visibility to structural similarity", IEEE Trans. Image Process. 13(4), 2004, Eq. 13,
//   SSIM(x, y) = (2 mx my + C1) (2 sxy + C2) / ((mx^2 + my^2 + C1) (sx^2 + sy^2 + C2)),
// with means m, variances s^2 and covariance sxy under an 11 x 11 Gaussian window of standard
// deviation 1.5, C1 = (0.01 * 255)^2 and C2 = (0.03 * 255)^2, averaged with `weights` (0:
// excluded). The window includes only pixels with `inside` > 0, with renormalised weights; all
// pixels if `inside` is empty. 1 for equal pictures, symmetric, at most 1; none without weight.
// Grey levels 0 to 255, row-major. Precondition: equal sizes; weights > 0 only inside.
std::optional<double> structuralSimilarity(std::span<const float> x, std::span<const float> y,
                                           std::span<const float> inside,
                                           std::span<const float> weights, int rows, int columns);

}  // namespace echocine
