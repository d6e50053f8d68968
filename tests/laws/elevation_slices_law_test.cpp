// The beam across the imaging plane by a few slices, against its closed forms and against rays.

#include "scene/elevation_slices.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/beam_profile.h"
#include "scene/scan_geometry.h"
#include "support/beam_world.h"

namespace echocine {
namespace {

using namespace support;

constexpr double kDepth_m = 0.11;

// A sheet that leans out of the imaging plane: z = kDepth_m + lean y. Many facets, as edges of
// curved slices are straight between vertices.
World leaningSheet(double lean) {
  Mesh mesh = sheet(40, 0.02, kDepth_m);
  for (Vec3d& p : mesh.points) p.z += lean * p.y;
  return sheetWorld(mesh);
}

PolarFrame traceSlices(World world, int slices) {
  world.scene.accuracy.elevation_slices = slices;
  const EffectPlan plan = planEffects(world.scene);
  EXPECT_EQ(plan.elevation_slices, slices);
  return traceThickWorld(world, plan, EchoCells::none);
}

struct Moments {
  double sum = 0, mean = 0, variance = 0;
};

Moments momentsOf(const World& world, const std::vector<float>& echoes) {
  const ScanGeometry geometry(world.scene.probe);
  Moments m;
  double square = 0;
  for (std::size_t k = 0; k < echoes.size(); ++k) {
    const double z = geometry.sampleDepth(static_cast<int>(k)), e = static_cast<double>(echoes[k]);
    m.sum += e;
    m.mean += e * z;
    square += e * z * z;
  }
  m.mean /= m.sum;
  m.variance = square / m.sum - m.mean * m.mean;
  return m;
}

// E u^m of a standard normal number: 0, and (m - 1)!! of even m.
long double normalMoment(int m) {
  if (m % 2 == 1) return 0;
  long double product = 1;
  for (int i = m - 1; i > 1; i -= 2) product *= i;
  return product;
}

TEST(ElevationSlicesLaw, PolynomialsUpToDegreeTwoNLessOneAreExact) {
  for (const int n : {1, 3, 5}) {
    const auto sumOfPowers = [&](int m) {
      long double sum = 0;
      for (const ElevationNode& node : elevationNodes(n))
        sum += static_cast<long double>(node.weight) *
               std::pow(static_cast<long double>(node.place), static_cast<long double>(m));
      return static_cast<double>(sum);
    };
    ASSERT_EQ(elevationNodes(n).size(), static_cast<std::size_t>(n));
    EXPECT_EQ(elevationNodes(n).front().place, 0);
    for (int m = 0; m < 2 * n; ++m)
      EXPECT_NEAR(sumOfPowers(m), static_cast<double>(normalMoment(m)), 1e-13 * std::pow(4, m))
          << n << " slices, degree " << m;
    EXPECT_GT(std::abs(sumOfPowers(2 * n) - static_cast<double>(normalMoment(2 * n))), 0.5);
  }
}

// The deviation is that of the rays of beam_rays.h: w_e / sqrt(8 ln 4).
TEST(ElevationSlicesLaw, TheReachIsThatOfTheWidestSliceAtTheWidestDepth) {
  Scene scene = leaningSheet(0).scene;
  EXPECT_EQ(elevationReach(scene), 0);
  scene.accuracy.elevation_slices = 3;
  const Probe& p = scene.probe;
  const double wavelength_m = ScanGeometry(p).wavelength();
  double widest = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double z = p.max_depth_m * i / 1000,
                 width = elevationBeamWidth(z, p.elevation_aperture_m, p.elevation_focus_m,
                                            wavelength_m);
    EXPECT_NEAR(ElevationBell(p).deviation(z), width / std::sqrt(8 * std::log(4.0)), 1e-12);
    widest = std::max(widest, width);
  }
  EXPECT_NEAR(elevationReach(scene), std::sqrt(3.0) * widest / std::sqrt(8 * std::log(4.0)), 1e-9);
}

// Slice k meets the sheet where z = z_0 + lean u sigma(z). Its echo is there, its share q.
TEST(ElevationSlicesLaw, ALeaningSheetEchoesWhereEachSliceMeetsIt) {
  for (const double lean : {-0.5, 0.2, 0.7}) {
    const World world = leaningSheet(lean);
    const Probe& p = world.scene.probe;
    const double whole = wholeEcho(world);
    const ElevationBell bell(p);
    for (const int n : {3, 5}) {
      const PolarFrame polar = traceSlices(world, n);
      const std::vector<float>& echoes = polar.planes.at(Channel::reflection);
      EXPECT_NEAR(sumOf(echoes), whole, 1e-5 * whole);
      for (const ElevationNode& node : elevationNodes(n)) {
        double z = kDepth_m;
        for (int i = 0; i < 50; ++i) z = kDepth_m + lean * node.place * bell.deviation(z);
        double near = 0;
        const auto at = static_cast<std::size_t>((z - p.min_depth_m) / p.sampleSpacing());
        for (std::size_t k = at - 1; k <= at + 1; ++k) near += static_cast<double>(echoes[k]);
        EXPECT_NEAR(near, node.weight * whole, 1e-5 * whole) << lean << " " << node.place;
      }
    }
  }
}

// A second way to compute it: rays drawn over the lens. Their paths are longer by y^2 / 2 F of the
// lens, 0.06 mm in the mean.
TEST(ElevationSlicesLaw, MomentsOfALeaningSheetAreThoseOfManyRays) {
  for (const double lean : {0.3, 0.6}) {
    const World world = leaningSheet(lean);
    const Moments rays =
        momentsOf(world, traceWorld(world, beamPlan(world.scene, 4096, false, true), Tracer::embree)
                             .planes.at(Channel::reflection));
    for (const int n : {3, 5}) {
      const Moments slices = momentsOf(world, traceSlices(world, n).planes.at(Channel::reflection));
      EXPECT_NEAR(slices.sum, rays.sum, 1e-3 * rays.sum);
      EXPECT_NEAR(slices.mean, rays.mean, 1e-4) << n;
      EXPECT_NEAR(std::sqrt(slices.variance), std::sqrt(rays.variance),
                  0.04 * std::sqrt(rays.variance))
          << n;
    }
  }
}

// What does not change across the plane is the same in every slice.
TEST(ElevationSlicesLaw, ASceneThatIsTheSameAcrossThePlaneIsThatOfOneSlice) {
  const World world = leaningSheet(0);
  const std::vector<float> one = traceWorld(world, Tracer::slice).planes.at(Channel::reflection);
  for (const int n : {3, 5}) {
    const std::vector<float> several = traceSlices(world, n).planes.at(Channel::reflection);
    for (std::size_t k = 0; k < one.size(); ++k)
      ASSERT_NEAR(several[k], one[k], 1e-6f * one[k]) << k;
  }
}

}  // namespace
}  // namespace echocine
