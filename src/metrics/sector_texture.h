#pragma once
// Grey-level texture of the sector of an echo picture, the same measurement for real and simulated
// ones: statistics used for 500 clinical apical stills (Leclerc et al., IEEE TMI 38(9), 2198-2210,
// 2019). Lengths are millimetres, so pixel sizes may differ.

#include <cstdint>
#include <span>
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

// The statistics that depend neither on labels nor on the scanner's gain setting, by their names in
// that evaluation.
struct SectorStatistic {
  const char* name;
  double (*of)(const SectorTexture&);
};
std::span<const SectorStatistic> sectorStatistics();

// Element floor(q n) of the sorted values, at most the last; NaN without values.
double orderStatistic(std::vector<float> values, double q);

}  // namespace echocine
