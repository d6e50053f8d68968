// The laws of the coherent stage, on beds of scatterers that move by affine maps.

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "core/hash_random.h"
#include "core/parallel.h"
#include "metrics/block_match.h"
#include "metrics/statistics.h"
#include "scene/beam_profile.h"
#include "scene/scan_geometry.h"
#include "support/speckle_bed.h"

namespace echocine {
namespace {

using namespace support;

constexpr ProbeKind kAllKinds[] = {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear};

// Speckle scales each intensity by a random factor of mean 1.
TEST(SpeckleLaw, TheMeanOverSeedsIsThePictureWithout) {
  constexpr int kSeeds = 200;
  for (const ProbeKind kind : kAllKinds) {
    SpeckleBed bed(kind, 40, 192, 0.06, 0.09);
    bed.material.reach_m = 0.003;
    // A bright block that moves with the tissue's shift, a dark one, a step at the picture's edge.
    std::vector<float> without = bed.even();
    for (std::size_t i = 0; i < without.size(); ++i)
      without[i] = i % 192 < 60 ? 1e-4f : i % 192 < 120 ? 100.0f : i / 192 < 14 ? 0 : 0.3f;
    std::vector<double> sum(without.size());
    for (bed.settings.seed = 1; bed.settings.seed <= kSeeds; ++bed.settings.seed) {
      std::vector<float> with = without;
      bed.speckle().apply(shifted({1e-3, 5e-4, 2e-3}), 0.2, with);
      for (std::size_t i = 0; i < with.size(); ++i) sum[i] += with[i];
    }
    double mean = 0, squares = 0, n = 0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
      if (without[i] == 0) {
        EXPECT_EQ(sum[i], 0);
        continue;
      }
      const double ratio = sum[i] / kSeeds / static_cast<double>(without[i]);
      n += 1;
      mean += ratio;
      squares += (ratio - 1) * (ratio - 1);
    }
    EXPECT_NEAR(mean / n, 1, 0.01) << static_cast<int>(kind);
    EXPECT_NEAR(std::sqrt(squares / n), 1 / std::sqrt(kSeeds), 0.1 / std::sqrt(kSeeds));
  }
}

// A sum of complex Gaussian numbers is one however many they are; its modulus is Rayleigh's.
TEST(SpeckleLaw, TheEnvelopeIsRayleighAtAnyDensity) {
  for (const double per_cell : {3.0, 10.0}) {
    SpeckleBed bed(ProbeKind::phased, 250, 512, 0.04, 0.15);
    bed.settings.per_cell = per_cell;
    double n = 0, a = 0, aa = 0, i2 = 0, db = 0, db2 = 0;
    for (bed.settings.seed = 1; bed.settings.seed <= 4; ++bed.settings.seed)
      for (const float v : bed.picture(bed.speckle())) {
        const double intensity = v, level = 10 * std::log10(intensity);
        n += 1;
        a += std::sqrt(intensity);
        aa += intensity;
        i2 += intensity * intensity;
        db += level;
        db2 += level * level;
      }
    const double mean_a = a / n, mean_i = aa / n;
    EXPECT_NEAR(mean_a / std::sqrt(mean_i - mean_a * mean_a), 1.913, 0.019) << per_cell;
    EXPECT_NEAR(mean_i / std::sqrt(i2 / n - mean_i * mean_i), 1, 0.02);
    EXPECT_NEAR(std::sqrt(db2 / n - db / n * (db / n)), 5.57, 0.06);
  }
}

// Full width at half maximum of the intensity's autocorrelation, in samples (or lines), over seeds.
double widthOf(SpeckleBed bed, bool along) {
  constexpr int kSeeds = 8, kLags = 12;
  std::vector<double> mean(kLags);
  const Window w{8, bed.probe.lines - 8 - kLags, 8, bed.probe.samples - 8 - kLags};
  for (bed.settings.seed = 1; bed.settings.seed <= kSeeds; ++bed.settings.seed) {
    const std::vector<float> p = bed.picture(bed.speckle());
    for (int lag = 0; lag < kLags; ++lag)
      mean[static_cast<std::size_t>(lag)] +=
          correlation(p, p, bed.probe.samples, w, along ? 0 : lag, along ? lag : 0) / kSeeds;
  }
  return widthAtHalf(mean);
}

TEST(SpeckleLaw, CellsAreAsWideAsThePointSpreadAtEveryDepth) {
  for (const ProbeKind kind : kAllKinds)
    for (const double z : {0.05, 0.1, 0.15}) {
      const SpeckleBed bed(kind, 240, 160, z - 0.01, z + 0.01);
      const PointSpread spread(bed.probe, 2);
      EXPECT_NEAR(widthOf(bed, true) * bed.probe.sampleSpacing() / spread.axial_width_m, 1, 0.05)
          << z << " " << static_cast<int>(kind);
      EXPECT_NEAR(widthOf(bed, false) * lineSpacing(bed.probe, z) / spread.lateralWidth(z), 1, 0.05)
          << z << " " << static_cast<int>(kind);
    }
}

TEST(SpeckleLaw, RigidMotionByWholeLinesAndSamplesCarriesTheSpeckle) {
  SpeckleBed sector(ProbeKind::phased, 120, 400, 0.06, 0.12);
  const Speckle turns = sector.speckle();
  EXPECT_GT(
      correlation(sector.picture(turns), sector.picture(turns, turned(3 * radiansFromDegrees(0.3))),
                  400, {10, 105, 10, 390}, 3),
      0.998);
  SpeckleBed straight(ProbeKind::linear, 60, 400, 0.06, 0.1);
  const Speckle shifts = straight.speckle();
  const double pitch_m = lineSpacing(straight.probe, 0.08);
  EXPECT_GT(
      correlation(straight.picture(shifts), straight.picture(shifts, shifted({4 * pitch_m, 0, 0})),
                  400, {10, 45, 10, 390}, 4),
      0.998);
  const double five_m = 5 * straight.probe.sampleSpacing();
  EXPECT_GT(correlation(straight.picture(shifts), straight.picture(shifts, shifted({0, 0, five_m})),
                        400, {10, 50, 10, 380}, 0, 5),
            0.998);
}

TEST(SpeckleLaw, TissueThatRestsKeepsItsBytesAndBloodRenewsItself) {
  SpeckleBed bed(ProbeKind::phased, 100, 400, 0.06, 0.12);
  const Speckle tissue = bed.speckle();
  EXPECT_EQ(bed.picture(tissue, Affine{}, 0), bed.picture(tissue, Affine{}, 7.3));
  bed.material.flows = true;
  const Speckle blood = bed.speckle();
  const Window w{0, 100, 0, 400};
  const std::vector<float> now = bed.picture(blood, Affine{}, 1);
  EXPECT_NEAR(correlation(now, bed.picture(blood, Affine{}, 1.021), 400, w), 0, 0.05);
  EXPECT_GT(correlation(now, bed.picture(blood, Affine{}, 1.001), 400, w), 0.9);
}

// |correlation|^2 of the elevation's bell with itself after a shift, its wave curved by the lens
// and the bell cut where the splatter cuts it. Without the cut: exp(-d^2 / 2 s0^2).
double fadedBy(double shift_m, double s0, double sa) {
  constexpr int kSteps = 4000;
  const double cut = kElevationCut * sa * std::sqrt(8 * std::log(2.0));
  const double curvature = std::sqrt(std::max(0.0, 1 / (s0 * s0) - 1 / (sa * sa))) / sa;
  double real = 0, imaginary = 0, power = 0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double y = cut * i / kSteps, on = y + shift_m;
    const double bell = std::exp(-y * y / (2 * sa * sa));
    power += bell * bell;
    if (std::abs(on) > cut) continue;
    const double both = bell * std::exp(-on * on / (2 * sa * sa));
    real += both * std::cos(curvature * (on * on - y * y) / 2);
    imaginary += both * std::sin(curvature * (on * on - y * y) / 2);
  }
  return (real * real + imaginary * imaginary) / (power * power);
}

// Few scatterers share phases by chance: 3 per cell leave 0.07 more where the form has 0.14.
TEST(SpeckleLaw, AcrossThePlaneItFadesByDiffractionAloneAtEveryDepth) {
  for (const double z : {0.05, 0.08, 0.14}) {
    SpeckleBed bed(ProbeKind::phased, 160, 400, z - 0.01, z + 0.01);
    const double s0 =
        followedWidth(z, bed.probe.elevation_aperture_m, ScanGeometry(bed.probe).wavelength()) /
        std::sqrt(2.0) / std::sqrt(8 * std::log(2.0));
    bed.settings.per_cell = 12;
    constexpr int kSeeds = 4;
    const double parts[] = {0.5, 1.0, 1.5};
    double mean[3] = {};
    for (bed.settings.seed = 1; bed.settings.seed <= kSeeds; ++bed.settings.seed) {
      const Speckle speckle = bed.speckle();
      const std::vector<float> here = bed.picture(speckle);
      for (int i = 0; i < 3; ++i)
        mean[i] += correlation(here, bed.picture(speckle, shifted({0, parts[i] * s0, 0})), 400,
                               {0, 160, 0, 400}) /
                   kSeeds;
    }
    const double sa = PointSpread(bed.probe, 2).elevationWidth(z) / std::sqrt(8 * std::log(2.0));
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(mean[i], fadedBy(parts[i] * s0, s0, sa), 0.04) << z << " " << parts[i];
      EXPECT_NEAR(mean[i], std::exp(-parts[i] * parts[i] / 2), parts[i] > 1 ? 0.08 : 0.05);
    }
  }
}

// Scatterers at a distance d from what rests have moved by s d, and those within one cell have
// turned their phases against each other: exp(-(s d)^2 / 2 sigma^2) exp(-(2 k s sigma)^2 / 2).
// Within 1.5 mm that is 0.95 and 0.84 for strains of 5 and 10 %.
TEST(SpeckleLaw, StrainAlongTheBeamTakesItsCorrelationAway) {
  SpeckleBed bed(ProbeKind::linear, 600, 200, 0.07, 0.09);
  const Speckle speckle = bed.speckle();
  const double sigma_m = speckle.spread().axial_m;
  const int half = static_cast<int>(1.5e-3 / bed.probe.sampleSpacing());
  const Window w{0, 600, 100 - half, 100 + half};
  const std::vector<float> before = bed.picture(speckle);
  for (const double strain : {0.05, 0.1}) {
    const double turned = 4 * std::numbers::pi / speckle.spread().wavelength_m * strain * sigma_m;
    double moved = 0;
    for (int k = 0; k < half; ++k) {
      const double away = strain * (k + 0.5) * bed.probe.sampleSpacing() / sigma_m;
      moved += std::exp(-away * away / 2) / half;
    }
    const double after = correlation(before, bed.picture(speckle, stretched(strain, 0.08)), 200, w);
    EXPECT_NEAR(after, moved * std::exp(-turned * turned / 2), 0.03) << strain;
  }
}

// What a tracker finds is how the material moved: a turn, a stretch and a shift at once, up to
// 1.5 mm a frame, as tissue moves.
TEST(SpeckleLaw, BlockMatchingFindsASmoothMotion) {
  SpeckleBed bed(ProbeKind::phased, 200, 640, 0.04, 0.14);
  bed.settings.smoothing_m = 0.7e-3;
  const Speckle speckle = bed.speckle();
  Affine moved = turned(radiansFromDegrees(0.4));
  moved.x = 0.99 * moved.x;
  moved.z = 1.008 * moved.z;
  moved.shift = {6e-4, 1e-4, -7e-4};
  std::vector<float> before = bed.picture(speckle), after = bed.picture(speckle, moved);
  for (std::vector<float>* plane : {&before, &after})
    for (float& v : *plane) v = std::log(v);  // as pictures show it
  const auto plane = [&](const std::vector<float>& values) {
    return BlockPlane{.values = values, .lines = bed.probe.lines, .samples = bed.probe.samples};
  };
  const auto placeOf = [&](double line, double sample) {
    const double angle = bed.probe.first_angle_rad + line * radiansFromDegrees(0.3);
    const double r = bed.probe.min_depth_m + (sample + 0.5) * bed.probe.sampleSpacing();
    return Vec3d{r * std::sin(angle), 0, r * std::cos(angle)};
  };
  std::vector<double> errors_mm;
  for (int line = 16; line < 184; line += 8)
    for (int sample = 40; sample < 600; sample += 28) {
      const auto match = matchBlock(plane(before), plane(after), line, sample);
      ASSERT_TRUE(match) << line << " " << sample;
      const Vec3d from = placeOf(line, sample);
      const Vec3d true_place = from.x * moved.x + from.z * moved.z + moved.shift;
      const Vec3d found = placeOf(line + match->lines, sample + match->samples);
      errors_mm.push_back(1e3 * std::hypot(found.x - true_place.x, found.z - true_place.z));
    }
  EXPECT_LT(quartilesOf(errors_mm).median, 0.07);
  EXPECT_LT(quartilesOf(errors_mm).third_quartile, 0.12);
}

// A sheet across the beam 8 cm deep, in blood that renews itself.
TEST(SpeckleLaw, ASheetKeepsItsSpeckleInBloodAndTakesItAlong) {
  SpeckleBed bed(ProbeKind::linear, 60, 200, 0.07, 0.09);
  bed.material.flows = true;
  const Speckle blood = bed.speckle();
  Affine now;
  for (int i = 0; i < 20000; ++i)
    now.on_sheets_m.push_back({static_cast<float>(0.04 * (uniformFromHash(hashOf(i, 1)) - 0.5)),
                               static_cast<float>(0.02 * (uniformFromHash(hashOf(i, 2)) - 0.5)),
                               0.08f});
  const double five_m = 5 * bed.probe.sampleSpacing();
  Affine later = shifted({0, 0, five_m});
  for (const Vec3f p : now.on_sheets_m)
    later.on_sheets_m.push_back(p + Vec3f{0, 0, static_cast<float>(five_m)});
  const std::vector<float> one = bed.picture(blood, now, 0.1), two = bed.picture(blood, later, 0.2);
  EXPECT_GT(correlation(one, two, 200, {5, 55, 98, 102}, 0, 5), 0.9);  // the sheet
  EXPECT_LT(correlation(one, two, 200, {5, 55, 20, 80}, 0, 5), 0.15);  // blood before it
}

TEST(SpeckleLaw, TheIntensityScalesThroughAndOrderAndThreadsLeaveTheBytes) {
  SpeckleBed bed(ProbeKind::curvilinear, 60, 300, 0.02, 0.1);
  bed.settings.smoothing_m = 0.7e-3;
  const Speckle speckle = bed.speckle();
  const std::vector<float> one = bed.picture(speckle);
  std::vector<float> more = bed.even(64);
  speckle.apply(Affine{}, 0, more);
  for (std::size_t i = 0; i < one.size(); ++i) ASSERT_FLOAT_EQ(more[i], 64 * one[i]);
  (void)bed.picture(speckle, shifted({2e-3, 0, 0}), 0.3);
  EXPECT_EQ(bed.picture(speckle), one);
  for (const int threads : {1, 2})
    withThreads(threads, [&] { EXPECT_EQ(bed.picture(bed.speckle()), one) << threads; });
}

TEST(SpeckleLaw, SmoothingKeepsTheMean) {
  SpeckleBed bed(ProbeKind::phased, 60, 300, 0.05, 0.09);
  const std::vector<float> raw = bed.picture(bed.speckle());
  bed.settings.smoothing_m = 0.7e-3;
  const std::vector<float> smooth = bed.picture(bed.speckle());
  const auto mean = [](const std::vector<float>& p) {
    return std::accumulate(p.begin(), p.end(), 0.0) / static_cast<double>(p.size());
  };
  EXPECT_NEAR(mean(smooth) / mean(raw), 1, 1e-5);
}

TEST(SpeckleLaw, WithoutAScattererInReachThePictureStaysAsItIs) {
  SpeckleBed bed(ProbeKind::phased, 40, 200, 0.05, 0.09);
  const Speckle speckle = bed.speckle();
  EXPECT_EQ(bed.picture(speckle, shifted({0, 0.5, 0})), bed.even());
}

}  // namespace
}  // namespace echocine
