// The bundle of rays that stands for a beam: its points, its weights, and its width at every depth.

#include "scene/scan_geometry.h"
#include "trace/beam_rays.h"

#include <gtest/gtest.h>

#include <bit>
#include <set>

#include "core/hash_random.h"
#include "scene/beam_profile.h"
#include "support/plain_scene.h"

namespace echocine {
namespace {

using namespace support;

constexpr double kDepths_m[] = {0.005, 0.02, 0.05, 0.08, 0.12, 0.16};

// A sample centred at each millimetre from 1 to 160.
Probe probe() {
  Probe p = plainScene({medium("tissue", 1000, 1540)}).probe;
  p.min_depth_m = 0.0005;
  p.max_depth_m = 0.1605;
  p.elevation_aperture_m = 0.013;
  p.elevation_focus_m = 0.07;
  return p;
}

std::size_t sampleAt(double depth_m) {
  return static_cast<std::size_t>(std::lround(depth_m * 1e3) - 1);
}

// Law: Q(q(u)) = u, with Q from erfc.
TEST(BeamRaysLaw, QuantileIsTheInverseOfTheNormalDistribution) {
  for (int e = -330; e < 0; ++e) {
    const double u = std::pow(10.0, e / 10.0) / 2;
    for (const double v : {u, 1 - u}) {
      if (v > 1 - 1e-9) continue;  // its complement's digits are gone before the quantile is asked
      const long double q = normalQuantile(v);
      const long double back = 0.5L * std::erfc(-q / std::numbers::sqrt2_v<long double>);
      // Near 1 a quantile is no better than its argument's rounding.
      EXPECT_NEAR(static_cast<double>(back / static_cast<long double>(v)), 1, 1e-8) << v;
    }
  }
  EXPECT_NEAR(normalQuantile(0.5), 0, 1e-15);
  EXPECT_NEAR(normalQuantile(0.975), 1.959963984540054, 1e-9);
}

// One point in each nth of the unit interval, whatever n: no number of rays wastes any.
TEST(BeamRaysLaw, AnyNumberOfPointsIsStratifiedInTheFirstDimension) {
  for (int n = 1; n <= 100; ++n) {
    std::set<int> strata;
    for (int i = 0; i < n; ++i) {
      const std::array<double, 3> point = beamPoint(hashOf(n), i, n);
      for (const double x : point) ASSERT_TRUE(x > 0 && x < 1) << x;
      strata.insert(static_cast<int>(point[0] * n));
    }
    EXPECT_EQ(strata.size(), static_cast<std::size_t>(n));
  }
}

// Every box of sides 2^-a, 2^-b, 2^-c with a + b + c = m holds one of 2^m points.
// A (0, m, 3)-net: one point in every box of volume 1/n that halves the sides in any way.
TEST(BeamRaysLaw, APowerOfTwoOfPointsIsANetInThreeDimensions) {
  constexpr int m = 6, n = 1 << m;
  for (std::uint64_t pattern = 0; pattern < 20; ++pattern)
    for (int a = 0; a <= m; ++a)
      for (int b = 0; a + b <= m; ++b) {
        const int c = m - a - b;
        std::set<int> boxes;
        for (int i = 0; i < n; ++i) {
          const std::array<double, 3> p = beamPoint(hashOf(pattern), i, n);
          boxes.insert((static_cast<int>(p[0] * (1 << a)) << (b + c)) +
                       (static_cast<int>(p[1] * (1 << b)) << c) +
                       static_cast<int>(p[2] * (1 << c)));
        }
        EXPECT_EQ(boxes.size(), static_cast<std::size_t>(n)) << a << " " << b << " " << c;
      }
}

// Equal patterns would stand in the loop as a texture that does not move.
TEST(BeamRaysLaw, PatternsDifferBetweenFramesLinesAndSeeds) {
  std::set<std::uint64_t> patterns;
  for (const int seed : {1, 2})
    for (int frame = 0; frame < 30; ++frame)
      for (int line = 0; line < 30; ++line)
        patterns.insert(BeamRays(probe(), {.rays = 4, .seed = seed}).pattern(frame, line));
  EXPECT_EQ(patterns.size(), 2u * 30 * 30);
}

TEST(BeamRaysLaw, WeightsAreTransmitsBellAtThePlaceOfTheRay) {
  const Probe p = probe();
  const BeamRays beams(p, {.rays = 1});
  std::vector<float> weights(static_cast<std::size_t>(p.samples));
  const LineGeometry line = lineGeometry(p, 0);
  for (const double q : {0.0, 0.3, -1.0, 2.5, 4.0, 9.0}) {
    beams.weights(beams.through(line, q, 0, 0), weights);
    for (const double z : kDepths_m) {
      const double x =
          q * followedWidth(z, p.aperture_m, ScanGeometry(p).wavelength()) / kWidthPerDeviation;
      const double w_t = focusedWidth(z, p.aperture_m, p.focus_m, ScanGeometry(p).wavelength());
      const long double bell = std::exp(-4 * std::log(4.0L) * x * x / (w_t * w_t));
      EXPECT_NEAR(weights[sampleAt(z)], static_cast<double>(bell), 1e-5 * static_cast<double>(bell))
          << "q " << q << ", depth " << z;
    }
  }
}

// Second moments of the product of both ways' bells, by quadrature.
long double twoWayVariance(long double w_t, long double w_r) {
  long double sum = 0, moment = 0;
  const long double step = w_r / 1000;
  for (int i = -5000; i <= 5000; ++i) {
    const long double x = i * step;
    const long double bells =
        std::exp(-4 * std::log(4.0L) * x * x * (1 / (w_t * w_t) + 1 / (w_r * w_r)));
    sum += bells;
    moment += bells * x * x;
  }
  return moment / sum;
}

struct Moments {
  double x = 0, y = 0, within_x = 0, within_y = 0;
};

// Of the weighted bundle where it passes a depth, with the shares within the -6 dB widths.
Moments momentsAt(double z, const Probe& p, const BeamRays& beams, double width_x, double width_y) {
  const LineGeometry line = lineGeometry(p, 0);
  std::vector<float> weights(static_cast<std::size_t>(p.samples));
  Moments m;
  double sum = 0;
  for (int i = 0; i < beams.count(); ++i) {
    const BeamRay ray = beams.ray(line, beams.pattern(0, 0), i);
    beams.weights(ray, weights);
    const double w = weights[sampleAt(z)];
    const Vec3d at = ray.ray.origin + (z / ray.ray.direction.z) * ray.ray.direction;
    sum += w;
    m.x += w * at.x * at.x;
    m.y += w * at.y * at.y;
    m.within_x += std::abs(at.x) < width_x / 2 ? w : 0;
    m.within_y += std::abs(at.y) < width_y / 2 ? w : 0;
  }
  for (double* value : {&m.x, &m.y, &m.within_x, &m.within_y}) *value /= sum;
  return m;
}

// Law: 1/w^2 = 1/w_t^2 + 1/w_r^2 at every depth, though rays are drawn once.
TEST(BeamRaysLaw, TheWeightedBundleIsAsWideAsTheTwoWayBeamAtEveryDepth) {
  const Probe p = probe();
  const double wavelength = ScanGeometry(p).wavelength();
  const BeamRays beams(p, {.rays = 4096});
  const double within = std::erf(std::sqrt(std::log(4.0)));  // of a bell within its -6 dB width
  for (const double z : kDepths_m) {
    SCOPED_TRACE(z);
    const double w_r = followedWidth(z, p.aperture_m, wavelength);
    const double w_t = focusedWidth(z, p.aperture_m, p.focus_m, wavelength);
    const double width_x = focusedBeamWidth(z, p.aperture_m, p.focus_m, wavelength);
    const double width_y =
        elevationBeamWidth(z, p.elevation_aperture_m, p.elevation_focus_m, wavelength);
    const double w_e = focusedWidth(z, p.elevation_aperture_m, p.elevation_focus_m, wavelength);
    const Moments m = momentsAt(z, p, beams, width_x, width_y);
    EXPECT_NEAR(m.x / static_cast<double>(twoWayVariance(w_t, w_r)), 1, 3e-3);
    EXPECT_NEAR(m.y / static_cast<double>(twoWayVariance(w_e, w_e)), 1, 1e-2);
    EXPECT_NEAR(m.within_x, within, 2e-3);
    EXPECT_NEAR(m.within_y, within, 5e-3);
  }
}

// Paths from the lens to its focus are equal, so the focus is at one depth for all of it.
// What makes a lens: all its paths to the focus are of one length.
TEST(BeamRaysLaw, ThePathsOfTheLensToItsFocusAreEqual) {
  const Probe p = probe();
  const BeamRays beams(p, {.rays = 1});
  for (const double lens : {-4.0, -1.0, 0.0, 0.5, 3.0}) {
    const BeamRay ray = beams.through(lineGeometry(p, 0), 0, lens, 0);
    const Vec3d focus = ray.ray.origin + (ray.start_m + p.elevation_focus_m) * ray.ray.direction;
    EXPECT_NEAR(focus.y, 0, 1e-12);
    EXPECT_NEAR(focus.z, p.elevation_focus_m, 1e-12);
    EXPECT_GE(ray.start_m, 0);
  }
}

TEST(BeamRaysLaw, WithoutElevationRaysStayInTheImagingPlaneAndStartWithTheLine) {
  Probe p = probe();
  p.kind = ProbeKind::curvilinear;
  p.face_radius_m = 0.04;
  p.lines = 7;
  const BeamRays beams(p, {.rays = 33, .elevation = false});
  for (int l = 0; l < p.lines; ++l)
    for (int i = 0; i < beams.count(); ++i) {
      const LineGeometry line = lineGeometry(p, l);
      const BeamRay ray = beams.ray(line, beams.pattern(3, l), i);
      EXPECT_EQ(ray.ray.origin, line.origin);
      EXPECT_EQ(ray.ray.direction.y, 0);
      EXPECT_EQ(ray.start_m, 0);
      EXPECT_NEAR(length(ray.ray.direction), 1, 1e-15);
    }
}

}  // namespace
}  // namespace echocine
