#pragma once
// Difference between two pictures: the error measures of the study and of the tolerance.

#include <optional>
#include <span>
#include <vector>

#include "signal/picture.h"

namespace echocine {

// Let g, h be the grey levels (0..1, before rounding to 8 bits) of the N pixels of the sector in
// two scan-converted pictures of the same size, and D the dynamic range in dB of grey 0..1. Then
//   e_i = D |g_i - h_i|,   rms_db = sqrt(sum e_i^2 / N),   max_db = max e_i.
// Grey is limited by black and white, so differences outside the displayed range do not count, and
// both are at most D. Symmetric in the pictures; rms_db <= max_db; 0 for equal pictures.
struct PictureError {
  double rms_db = 0, max_db = 0;
};

// Pixels outside the sector are negative in both (ScanConverter::convert) and are excluded. An
// empty sector has no error. Precondition: equal sizes.
PictureError pictureError(std::span<const float> a, std::span<const float> b,
                          double dynamic_range_db);

// structural_similarity.h over the pixels of the sector; its window also includes pixels beside the
// sector. 1 for an empty sector. `sector`: the picture as floats, negative outside the sector.
// Precondition: equal sizes.
double structuralSimilarity(const GreyImage& a, const GreyImage& b, std::span<const float> sector);

}  // namespace echocine
