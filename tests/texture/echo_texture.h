#pragma once
// Texture of the labelled regions of an echo picture, beside that of its sector.

#include "metrics/sector_texture.h"

namespace echocine {

// Texture of the labelled regions, each without its outer two pixels. NaN without labels.
struct RegionTexture {
  double cavity_grey = 0, myocardium_grey = 0, atrium_grey = 0;  // medians
  double myocardial_local_std = 0;  // median standard deviation in 5 x 5 pixels
  // Standard deviation of the residual: grey minus its mean over +-4 mm of the same region.
  double myocardial_detrended_std = 0, cavity_detrended_std = 0;
  // Full width at half maximum of the residual's autocovariance, along rows and columns, mm.
  double cell_horizontal_mm = 0, cell_vertical_mm = 0;
  // Medians of the myocardium on either side of the cavity, between 30 and 70 % of its rows. In a
  // four-chamber view with the septum on the left: septum and lateral wall.
  double left_wall_grey = 0, right_wall_grey = 0;
  double residual_skew = 0;    // of the myocardium; log-Rayleigh has -1.14
  double level_std_slope = 0;  // standard deviation per 100 grey levels, over 5 x 5 windows
};
RegionTexture regionTexture(const EchoPicture& picture);

}  // namespace echocine
