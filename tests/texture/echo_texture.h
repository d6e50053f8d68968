#pragma once
// Grey-level texture of an echo picture, the same measurement for real and simulated ones: the
// statistics used for 500 clinical apical stills (Leclerc et al., IEEE TMI 38(9), 2198-2210, 2019).
// Lengths are millimetres, so pixel sizes may differ.

#include <cstdint>
#include <vector>

namespace echocine {

// Rows from the top, the transducer at the top. Grey 0 to 255; 0 is outside the sector.
struct EchoPicture {
  int width = 0, height = 0;
  double pixel_x_m = 0, pixel_y_m = 0;
  std::vector<float> grey;
  // 0 background, 1 cavity, 2 myocardium of the left ventricle, 3 left atrium; empty: unknown.
  std::vector<std::uint8_t> labels{};
};

// Texture of the whole sector, which in each row extends from the first to the last pixel above 0.
// The interior are pixels whose box of +-3 mm is filled by the sector to 99.9 %. NaN if not
// measurable.
struct SectorTexture {
  double local_std = 0;                       // median standard deviation in boxes of +-0.75 mm
  double detrended_std = 0;                   // root mean square of grey minus its mean over +-4 mm
  double gradient_p50 = 0, gradient_p95 = 0;  // grey per mm, after a mean over +-0.5 mm
  double ridge_fraction = 0;  // fraction above grey 120 and 40 above both sides, 1 mm away
  // Correlation of grey minus its mean over +-3 mm, at distances of 1, 2, 4 and 8 mm away from the
  // apex, and across.
  double radial[4] = {}, tangential[4] = {};
  double grey_p5 = 0, grey_p50 = 0, grey_p95 = 0;
  double near_field_grey = 0;  // median of the first 15 mm of rows
  double dark_fraction = 0;    // fraction of the sector below grey 20
};
inline constexpr double kTextureLags_mm[] = {1, 2, 4, 8};
SectorTexture sectorTexture(const EchoPicture& picture);

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

// Element floor(q n) of the sorted values, at most the last; NaN without values.
double orderStatistic(std::vector<float> values, double q);

}  // namespace echocine
