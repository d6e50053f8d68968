// Decorrelation across the imaging plane beyond two standard deviations: what few scatterers leave.

#include <gtest/gtest.h>

#include <cmath>

#include "scene/beam_profile.h"
#include "scene/scan_geometry.h"
#include "support/speckle_bed.h"

namespace echocine {
namespace {

using namespace support;

// Correlation of pictures before and after a shift of `parts` s0 across the plane, less
// exp(-parts^2 / 2): the mean over seeds.
double excessOfTail(double z, double per_cell, double parts) {
  SpeckleBed bed(ProbeKind::phased, 160, 400, z - 0.01, z + 0.01);
  bed.settings.per_cell = per_cell;
  const double s0 =
      followedWidth(z, bed.probe.elevation_aperture_m, ScanGeometry(bed.probe).wavelength()) /
      std::sqrt(2.0) / kWidthAtHalf;
  constexpr int kSeeds = 4;
  double mean = 0;
  for (bed.settings.seed = 1; bed.settings.seed <= kSeeds; ++bed.settings.seed) {
    const Speckle speckle = bed.speckle();
    mean += correlation(bed.picture(speckle), bed.picture(speckle, shifted({0, parts * s0, 0})),
                        400, {0, 160, 0, 400}) /
            kSeeds;
  }
  return mean - std::exp(-parts * parts / 2);
}

// A tail that scatterers share by chance falls with their number; the cut of the bell leaves 0.04.
TEST(ElevationTail, FallsWithTheNumberOfScatterers) {
  for (const double z : {0.03, 0.135})
    for (const double parts : {2.0, 3.0}) {
      const double few = excessOfTail(z, 3, parts), many = excessOfTail(z, 12, parts);
      EXPECT_LT(few, 0.15) << z << ' ' << parts;
      EXPECT_LT(many, 0.06) << z << ' ' << parts;
      if (z < 0.05) {
        EXPECT_LT(many, 0.5 * few) << parts;
      }
    }
}

}  // namespace
}  // namespace echocine
