// Speckle of a radial probe: the same across the seam as elsewhere.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/scan_geometry.h"
#include "support/speckle_bed.h"

namespace echocine::radial_speckle_law {
namespace {

using support::Affine;
using support::SpeckleBed;
using support::turned;

constexpr int kLines = 120, kSamples = 192;

// 120 lines from 10 mm about the axis to 40 mm.
SpeckleBed radialBed() {
  SpeckleBed bed(ProbeKind::curvilinear, kLines, kSamples, 0.005, 0.035);
  support::lookAllRound(0.005, bed.probe);
  bed.probe.frequency_hz = 5e6;
  bed.probe.aperture_m = 0.002;
  bed.probe.focus_m = 0.02;
  bed.material.reach_m = 0.001;
  return bed;
}

double meanOf(const std::vector<float>& plane, int line) {
  double sum = 0;
  for (int k = 0; k < kSamples; ++k)
    sum += static_cast<double>(plane[static_cast<std::size_t>(line * kSamples + k)]);
  return sum / kSamples;
}

// Over the samples of line i of one plane and line j of another.
double likeness(const std::vector<float>& a, int i, const std::vector<float>& b, int j) {
  return support::correlation(a, b, kSamples, {i, i + 1, 0, kSamples}, j - i);
}

// Mean 1 on every line, and neighbours alike by the same, over seeds: within 4.5 standard errors.
TEST(RadialSpeckle, LinesBesideTheSeamHaveTheStatisticsOfAllLines) {
  constexpr int kSeeds = 24;
  std::vector<double> mean(kLines), mean_square(kLines), like(kLines), like_square(kLines);
  for (int seed = 0; seed < kSeeds; ++seed) {
    SpeckleBed bed = radialBed();
    bed.settings.seed = static_cast<std::uint64_t>(seed + 1);
    const std::vector<float> plane = bed.picture(bed.speckle());
    for (int i = 0; i < kLines; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double m = meanOf(plane, i), l = likeness(plane, i, plane, (i + 1) % kLines);
      mean[at] += m / kSeeds;
      mean_square[at] += m * m / kSeeds;
      like[at] += l / kSeeds;
      like_square[at] += l * l / kSeeds;
    }
  }
  double all_like = 0, spread = 0, like_spread = 0;
  for (std::size_t i = 0; i < kLines; ++i) {
    all_like += like[i] / kLines;
    spread += (mean_square[i] - mean[i] * mean[i]) / kLines;
    like_spread += (like_square[i] - like[i] * like[i]) / kLines;
  }
  const double error = std::sqrt(spread / (kSeeds - 1)),
               like_error = std::sqrt(like_spread / (kSeeds - 1));
  EXPECT_GT(all_like, 0.2);
  for (std::size_t i = 0; i < kLines; ++i) {
    EXPECT_NEAR(mean[i], 1, 4.5 * error) << i;
    EXPECT_NEAR(like[i], all_like, 4.5 * like_error) << i;
  }
}

// Tissue that turns by whole lines takes its speckle along, across the seam as well. Cubes are
// trilinear in beam space, so that not all of it is the same: the correlation is that of lines away
// from the seam.
TEST(RadialSpeckle, TurnsWithTheTissueAcrossTheSeam) {
  const SpeckleBed bed = radialBed();
  const Speckle speckle = bed.speckle();
  const std::vector<float> before = bed.picture(speckle);
  for (const int lines : {1, 30, 60}) {
    const std::vector<float> after =
        bed.picture(speckle, turned(lines * 2 * std::numbers::pi / kLines));
    double least = 1;
    for (int i = 0; i < kLines; ++i)
      least = std::min(least, likeness(before, i, after, (i + lines) % kLines));
    EXPECT_GT(least, 0.98) << lines;
  }
}

// The lines of a part of the turn are those of the whole.
TEST(RadialSpeckle, SomeLinesAreThoseOfAll) {
  const SpeckleBed bed = radialBed();
  const Speckle speckle = bed.speckle();
  const std::vector<float> whole = bed.picture(speckle);
  for (const LineRange lines : {LineRange{0, 7}, {50, 60}, {110, kLines}}) {
    std::vector<float> some = bed.even();
    speckle.apply(Affine{}, 0, some, {}, lines);
    for (int i = lines.first * kSamples; i < lines.end * kSamples; ++i)
      ASSERT_EQ(some[static_cast<std::size_t>(i)], whole[static_cast<std::size_t>(i)]) << i;
  }
}

}  // namespace
}  // namespace echocine::radial_speckle_law
