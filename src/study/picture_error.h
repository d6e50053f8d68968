#pragma once
// How far one picture is from another: the error measures of the study and of the tolerance.

#include <optional>
#include <span>
#include <vector>

#include "signal/picture.h"

namespace echocine {

// With g, h the grey values (0..1, before they become 8 bits) of the N pixels of the sector in two
// scan-converted pictures of the same size, and D the dynamic range in dB that grey 0..1 stands
// for,
//   e_i = D |g_i - h_i|,   rms_db = sqrt(sum e_i^2 / N),   max_db = max e_i.
// Grey ends at black and white, so nothing outside the displayed range counts, and both are at most
// D. Symmetric in the pictures; rms_db <= max_db; 0 for equal pictures.
struct PictureError {
  double rms_db = 0, max_db = 0;
};

// Pixels outside the sector are negative in both (ScanConverter::convert) and left out. An empty
// sector has no error. Precondition: equal sizes.
PictureError pictureError(std::span<const float> a, std::span<const float> b,
                          double dynamic_range_db);

// Mean structural similarity of two 8-bit pictures over the pixels of the sector: Wang, Bovik,
// Sheikh and Simoncelli, "Image quality assessment: from error visibility to structural
// similarity", IEEE Trans. Image Process. 13(4), 2004, Eq. 13,
//   SSIM(x, y) = (2 mx my + C1) (2 sxy + C2) / ((mx^2 + my^2 + C1) (sx^2 + sy^2 + C2)),
// with means m, variances s^2 and covariance sxy under their 11 x 11 Gaussian window of standard
// deviation 1.5, C1 = (0.01 * 255)^2 and C2 = (0.03 * 255)^2. Beyond the picture's edge the window
// sees it mirrored (theirs stays inside). 1 for equal pictures, symmetric, never above 1.
// `sector`: the picture as floats, negative outside the sector. Precondition: equal sizes.
double structuralSimilarity(const GreyImage& a, const GreyImage& b, std::span<const float> sector);

}  // namespace echocine
