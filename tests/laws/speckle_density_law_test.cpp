// Speckle of few scatterers per resolution cell.

#include <gtest/gtest.h>

#include <cmath>

#include "support/speckle_bed.h"

namespace echocine {
namespace {

using namespace support;

// Under one scatterer per cell the statistics are not those of the K distribution: where a sample
// has scatterers their number changes nothing, and where it has none the picture stands as it is.
TEST(SpeckleLaw, SparseScatterersAreRayleighOrLeaveTheSampleBare) {
  for (const double per_cell : {0.1, 0.2, 0.5}) {
    SpeckleBed bed(ProbeKind::phased, 250, 512, 0.04, 0.15);
    bed.settings.per_cell = per_cell;
    double n = 0, bare = 0, a = 0, aa = 0;
    for (bed.settings.seed = 1; bed.settings.seed <= 4; ++bed.settings.seed)
      for (const float v : bed.picture(bed.speckle())) {
        n += 1;
        if (v == 1) {
          bare += 1;
          continue;
        }
        a += std::sqrt(static_cast<double>(v));
        aa += static_cast<double>(v);
      }
    const double lit = n - bare, mean_a = a / lit, mean_i = aa / lit;
    EXPECT_NEAR(mean_a / std::sqrt(mean_i - mean_a * mean_a), 1.913, per_cell < 0.15 ? 0.12 : 0.05)
        << per_cell;
    EXPECT_NEAR(mean_i, 1, 0.06) << per_cell;
    // Poisson's chance of none within the 21 cells that a sample's point spread reaches.
    EXPECT_LT(bare / n, 1.3 * std::exp(-20 * per_cell)) << per_cell;
    EXPECT_GT(bare / n, 0.5 * std::exp(-22 * per_cell)) << per_cell;
  }
}

}  // namespace
}  // namespace echocine
