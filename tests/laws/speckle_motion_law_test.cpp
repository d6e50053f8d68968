// Speckle that moves by parts of a sample, and grain that does not depend on the sampling.

#include <gtest/gtest.h>

#include "core/units.h"
#include "support/measured.h"
#include "support/speckle_bed.h"

namespace echocine {
namespace {

using namespace support;

constexpr int kSamples = 320, kFiner = 16, kFinerLines = 8;
constexpr double kSpacing_m = 0.15625e-3;  // 1,024 samples in 16 cm

// Two pictures at places that match: RMS of their ratio, dB, and correlation.
struct Agreement {
  double flicker_db = 0, correlation = 0;
};
Agreement agreementOf(const std::vector<float>& a, const std::vector<float>& b) {
  double n = 0, squares = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = a[i], y = b[i];
    n += 1, squares += std::pow(10 * std::log10(x / y), 2);
    sa += x, sb += y, saa += x * x, sbb += y * y, sab += x * y;
  }
  return {std::sqrt(squares / n),
          (sab - sa * sb / n) / std::sqrt((saa - sa * sa / n) * (sbb - sb * sb / n))};
}

// A sector of 75 degrees; finer: as many steps in each interval between lines.
SpeckleBed sector(int lines, int finer = 1) {
  SpeckleBed bed(ProbeKind::phased, (lines - 1) * finer + 1, kSamples, 0.07,
                 0.07 + kSamples * kSpacing_m);
  bed.probe.first_angle_rad = -radiansFromDegrees(37.5);
  bed.probe.last_angle_rad = radiansFromDegrees(37.5);
  return bed;
}

// Tissue that turns by a part of a line is seen on coarse lines as on lines 8 times as fine, of
// which a whole number passes; the oracle's own rounding is 8 times as small.
TEST(SpeckleMotionLaw, PartsOfALineMoveSpeckleByTheSame) {
  Largest flicker_db("flicker", "dB"), off("correlation off by", "");
  for (const int lines : {96, 256}) {
    const SpeckleBed coarse = sector(lines), fine = sector(lines, kFinerLines);
    const double pitch_rad = radiansFromDegrees(75) / (lines - 1);
    const Speckle speckle = coarse.speckle();
    const std::vector<float> still = coarse.picture(speckle), ideal = fine.picture(fine.speckle());
    for (const int part : {1, 3, 4, 6}) {
      const std::vector<float> moved =
          coarse.picture(speckle, turned(part * pitch_rad / kFinerLines));
      std::vector<float> seen, expected, before, ideal_before;
      for (int i = 10; i < lines - 10; ++i)
        for (int k = 20; k < kSamples - 20; ++k) {
          const auto at = static_cast<std::size_t>(i * kSamples + k);
          const auto finely = [&](int steps) {
            return ideal[static_cast<std::size_t>((i * kFinerLines - steps) * kSamples + k)];
          };
          seen.push_back(moved[at]), before.push_back(still[at]);
          expected.push_back(finely(part)), ideal_before.push_back(finely(0));
        }
      EXPECT_LT(flicker_db(agreementOf(seen, expected).flicker_db), 0.3) << lines << " " << part;
      EXPECT_NEAR(off(agreementOf(before, seen).correlation -
                      agreementOf(ideal_before, expected).correlation),
                  0, 0.003)
          << lines << " " << part;
    }
  }
}

TEST(SpeckleMotionLaw, PartsOfASampleMoveSpeckleByTheSame) {
  Largest flicker_db("flicker", "dB"), off("correlation off by", "");
  const SpeckleBed coarse(ProbeKind::linear, 60, kSamples, 0.07, 0.07 + kSamples * kSpacing_m);
  const double step_m = kSpacing_m / kFiner;
  // The middles of coarse samples are those of fine ones.
  const SpeckleBed fine(ProbeKind::linear, 60, kSamples * kFiner, 0.07 + 0.5 * step_m,
                        0.07 + 0.5 * step_m + kSamples * kSpacing_m);
  const Speckle speckle = coarse.speckle();
  const std::vector<float> still = coarse.picture(speckle), ideal = fine.picture(fine.speckle());
  for (const int part : {1, 2, 7, 8, 13}) {
    const std::vector<float> moved = coarse.picture(speckle, shifted({0, 0, part * step_m}));
    std::vector<float> seen, expected, before, ideal_before;
    for (int i = 10; i < 50; ++i)
      for (int k = 20; k < kSamples - 20; ++k) {
        const auto at = static_cast<std::size_t>(i * kSamples + k);
        const auto finely = [&](int steps) {
          const int sample = k * kFiner + kFiner / 2 - 1 - steps;
          return ideal[static_cast<std::size_t>(i * kSamples * kFiner + sample)];
        };
        seen.push_back(moved[at]), before.push_back(still[at]);
        expected.push_back(finely(part)), ideal_before.push_back(finely(0));
      }
    EXPECT_LT(flicker_db(agreementOf(seen, expected).flicker_db), 0.3) << part;
    EXPECT_NEAR(off(agreementOf(before, seen).correlation -
                    agreementOf(ideal_before, expected).correlation),
                0, 0.003)
        << part;
  }
}

// The pulse is as long as it is, however finely 16 cm are sampled.
TEST(SpeckleMotionLaw, GrainAlongTheLineFollowsThePulseAtAnySamples) {
  Largest off("width of the grain off by", "");
  for (const int per_16cm : {512, 1024, 8192, 65536}) {
    const double spacing_m = 0.16 / per_16cm;
    const SpeckleBed bed(ProbeKind::linear, 160, static_cast<int>(0.03 / spacing_m), 0.08, 0.11);
    const std::vector<float> p = bed.picture(bed.speckle());
    const double width_m = PointSpread(bed.probe, 2).axial_width_m;
    const int apart = std::max(1, static_cast<int>(0.06 * width_m / spacing_m));
    std::vector<double> by_lag;
    for (int lag = 0; lag * apart * spacing_m < width_m; ++lag)
      by_lag.push_back(correlation(p, p, bed.probe.samples,
                                   {10, 150, 8, bed.probe.samples - 8 - lag * apart}, 0,
                                   lag * apart));
    EXPECT_NEAR(off(widthAtHalf(by_lag) * apart * bed.probe.sampleSpacing() / width_m - 1), 0, 0.05)
        << per_16cm;
  }
}

// Smoothing too: the coarse picture is the fine one's at its samples.
TEST(SpeckleMotionLaw, SmoothingFollowsItsWidthAtAnySamples) {
  SpeckleBed coarse(ProbeKind::linear, 40, 201, 0.07, 0.1);
  SpeckleBed fine(ProbeKind::linear, 40, 201 * 25, 0.07, 0.1);
  coarse.settings.smoothing_m = fine.settings.smoothing_m = 0.7e-3;
  const std::vector<float> a = coarse.picture(coarse.speckle()), b = fine.picture(fine.speckle());
  std::vector<float> seen, expected;
  for (int i = 5; i < 35; ++i)
    for (int k = 20; k < 181; ++k) {
      seen.push_back(a[static_cast<std::size_t>(i * 201 + k)]);
      expected.push_back(b[static_cast<std::size_t>(i * 201 * 25 + k * 25 + 12)]);
    }
  EXPECT_LT(agreementOf(seen, expected).flicker_db, 0.3);
}

}  // namespace
}  // namespace echocine
