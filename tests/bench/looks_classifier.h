#pragma once
// How well a linear and a boosted classifier of texture statistics tell simulated pictures
// from real ones, and which statistics give a picture away.

#include <string>
#include <vector>

#include "texture/echo_texture.h"

namespace echocine::bench {

// Pictures of one heart or of one real loop: they are much alike, so they are held out together.
struct PictureGroup {
  std::vector<SectorTexture> pictures;
};

// The picture with pixels of this size, each the mean of those it covers. It stays as it is if its
// own pixels are as large.
EchoPicture coarser(const EchoPicture& picture, double mm_per_pixel);

// Frames of a loop, every third: neighbours are nearly equal. Pixels outside the loop's sector are
// black, so that neither text nor traces of compression count as echo. coarse_mm: of coarser().
PictureGroup framesOf(const std::string& video, double mm_per_pixel, double coarse_mm);

// Fisher's linear discriminant and boosted stumps over the statistics that need no labels. Prints
// the area under the ROC curve of the pictures that they were fitted to and of those held out (each
// real loop in turn, with every other heart), and the two statistics of the greatest weight.
void printClassifier(const std::vector<PictureGroup>& simulated,
                     const std::vector<PictureGroup>& real);

}  // namespace echocine::bench
