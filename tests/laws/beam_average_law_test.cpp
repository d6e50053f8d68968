// What several rays per beam make of a scene, against closed forms of the beam's profile.

#include <gtest/gtest.h>

#include <numeric>

#include "scene/beam_profile.h"
#include "scene/scan_geometry.h"
#include "signal/signal_chain.h"
#include "support/beam_world.h"
#include "support/random_world.h"

namespace echocine {
namespace {

using namespace support;

double below(double x, double deviation) {
  return 0.5 * std::erfc(-x / (deviation * std::numbers::sqrt2));
}

Mesh rectangle(double x0, double x1, double y0, double y1, double z) {
  Mesh mesh = sheet(1, 1, z);
  for (Vec3d& p : mesh.points) p = {p.x < 0 ? x0 : x1, p.y < 0 ? y0 : y1, z};
  return mesh;
}

// Law: weights sum to 1 at every depth, so an even medium keeps its brightness.
TEST(BeamAverageLaw, InAUniformMediumManyRaysAreOneRay) {
  World world{plainScene({medium("a", 1000, 1540, 8, 1e-3), medium("b", 1000, 1540, 8, 1e-3)}),
              {icosphere(2, 0.03).moved({0.002, 0.003, 0.05})}};
  addStructure(world.scene, 1, 0);
  world.scene.probe.lines = 9;
  world.scene.output.channels = {Channel::y, Channel::unattenuated, Channel::attenuation,
                                 Channel::medium};
  world.scene.effects.refraction = Switch::off;
  const PolarFrame one = traceWorld(world, Tracer::embree);
  for (const int rays : {2, 3, 16, 100}) {
    const PolarFrame many = traceWorld(world, beamPlan(world.scene, rays), Tracer::embree);
    for (const Channel channel : {Channel::y, Channel::unattenuated, Channel::attenuation})
      for (std::size_t k = 0; k < one.planes.at(channel).size(); ++k)
        ASSERT_NEAR(many.planes.at(channel)[k] / one.planes.at(channel)[k], 1, 1e-6)
            << channelName(channel) << " " << k;
    EXPECT_EQ(many.medium, one.medium);
    EXPECT_EQ(many.planes.at(Channel::attenuation), one.planes.at(Channel::attenuation));
  }
}

// The mean of cos^n over the bundle's slopes at a depth, in long double: laterally the weights
// narrow their variance by 1 + rho, in elevation both ways of the lens have one each.
double meanLobe(const Probe& p, double z, int n) {
  const long double lambda = ScanGeometry(p).wavelength();
  const long double w_r = followedWidth(z, p.aperture_m, static_cast<double>(lambda));
  const long double w_t = focusedWidth(z, p.aperture_m, p.focus_m, static_cast<double>(lambda));
  const long double a = w_r / z / kWidthPerDeviation / std::sqrt(1 + w_r * w_r / (w_t * w_t));
  const long double lens = p.elevation_aperture_m / p.elevation_focus_m;
  const long double spread = 1.2067L * lambda / p.elevation_aperture_m;
  const long double b = std::hypot(lens, spread) / std::sqrt(2.0L) / kWidthPerDeviation;
  long double sum = 0, weight = 0;
  for (int i = -300; i <= 300; ++i)
    for (int j = -300; j <= 300; ++j) {
      const long double s = i / 40.0L, t = j / 40.0L, w = std::exp(-(s * s + t * t) / 2);
      sum += w * std::pow(1 + s * s * a * a + t * t * b * b, -n / 2.0L);
      weight += w;
    }
  return static_cast<double>(sum / weight);
}

// Law: an endless plane is met by all of the beam, each ray at its own angle.
TEST(BeamAverageLaw, APlaneAcrossTheBeamSendsBackItsLobesMeanOverTheProfile) {
  constexpr int n = 50;
  for (const ProbeKind kind : {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear})
    for (const double z : {0.03, 0.08, 0.14}) {
      World world = sheetWorld(sheet(1, 0.5, z), n);
      Probe& p = world.scene.probe;
      p.kind = kind;
      if (kind == ProbeKind::curvilinear) p.face_radius_m = 0.05;
      if (kind == ProbeKind::linear) {
        p.first_angle_rad = p.last_angle_rad = 0;
        p.first_offset_m = 0.01;
        p.last_offset_m = 0.03;
      }
      world.meshes[0] = sheet(1, 0.5, z + p.face_radius_m);
      const double share = echoOf(world, beamPlan(world.scene, 1024)) / wholeEcho(world);
      EXPECT_NEAR(share, meanLobe(p, z, n), 3e-4) << z;
      EXPECT_LT(share, 0.99);
    }
}

// Edges and strips (wires) at several places: the share of the beam that meets them.
TEST(BeamAverageLaw, AStripsLateralProfileIsTheTwoWayBeam) {
  const double lambda = ScanGeometry(sheetWorld(sheet(1, 1, 1)).scene.probe).wavelength();
  const double whole = wholeEcho(sheetWorld(sheet(1, 1, 1)));
  double worst = 0;
  for (const double z : {0.03, 0.08, 0.14}) {
    const double deviation = focusedBeamWidth(z, 0.02, 0.08, lambda) / kWidthPerDeviation;
    for (const double at : {-2.0, -0.7, 0.0, 0.4, 1.5})
      for (const double wide : {0.2, 1e3}) {
        const double x0 = at * deviation, x1 = (at + wide) * deviation;
        const World world = sheetWorld(rectangle(x0, std::min(x1, 0.5), -0.5, 0.5, z));
        const double expected = below(x1, deviation) - below(x0, deviation);
        const double share = echoOf(world, beamPlan(world.scene, 4096)) / whole;
        EXPECT_NEAR(share, expected, 1e-3) << "depth " << z << ", from " << x0;
        worst = std::max(worst, std::abs(share - expected));
      }
  }
  std::printf("worst share of the beam: %.2g\n", worst);
}

// Law: what a strip sends back is its share of the two-way profile.
TEST(BeamAverageLaw, AStripsElevationProfileIsTheTwoWayBeam) {
  const Probe probe = sheetWorld(sheet(1, 1, 1)).scene.probe;
  const double whole = wholeEcho(sheetWorld(sheet(1, 1, 1)));
  double worst = 0;
  for (const double z : {0.02, 0.07, 0.14}) {
    const double deviation =
        elevationBeamWidth(z, probe.elevation_aperture_m, probe.elevation_focus_m,
                           ScanGeometry(probe).wavelength()) /
        kWidthPerDeviation;
    for (const double at : {-2.0, -0.7, 0.0, 0.4, 1.5})
      for (const double wide : {0.2, 1e3}) {
        const double y0 = at * deviation, y1 = (at + wide) * deviation;
        const World world = sheetWorld(rectangle(-0.5, 0.5, y0, std::min(y1, 0.5), z));
        const double expected = below(y1, deviation) - below(y0, deviation);
        const double share = echoOf(world, beamPlan(world.scene, 4096)) / whole;
        EXPECT_NEAR(share, expected, 4e-3) << "depth " << z << ", from " << y0;
        worst = std::max(worst, std::abs(share - expected));
      }
  }
  std::printf("worst share of the beam: %.2g\n", worst);
}

// Half of the lens stands in another medium: what scatters back is what the beam's profile holds of
// each, whichever kind of probe.
// The probe's face may stand across a boundary: each ray starts in its own medium.
TEST(BeamAverageLaw, RaysOfOneBeamStartInDifferentMedia) {
  for (const ProbeKind kind : {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear}) {
    World world{plainScene({medium("a", 1000, 1540, 0, 1e-3), medium("b", 1000, 1540, 0, 3e-3)}),
                {box({-1, 0.001, -1}, {1, 1, 1})}};
    addStructure(world.scene, 1, 0);
    Probe& p = world.scene.probe;
    p.kind = kind;
    p.lines = 3;
    if (kind == ProbeKind::curvilinear) p.face_radius_m = 0.05;
    if (kind == ProbeKind::linear) {
      p.first_angle_rad = p.last_angle_rad = 0;
      p.first_offset_m = -0.01;
      p.last_offset_m = 0.01;
    }
    world.scene.output.channels = {Channel::backscatter};
    world.scene.output.cine = false;
    const PolarFrame polar = traceWorld(world, beamPlan(world.scene, 4096), Tracer::embree);
    const Sampling sampling = samplingOf(p);
    for (std::size_t k = 0; k < polar.planes.at(Channel::backscatter).size(); ++k) {
      const double l = sampling.centre(static_cast<double>(k % 160));
      const double deviation = elevationBeamWidth(l, p.elevation_aperture_m, p.elevation_focus_m,
                                                  ScanGeometry(p).wavelength()) /
                               kWidthPerDeviation;
      const double in_b = 1 - below(0.001, deviation);
      // Nearer than a wavelength the spread stays what it is there.
      const double held_m = std::max(l, ScanGeometry(p).wavelength());
      const double eta = polar.planes.at(Channel::backscatter)[k] * held_m * held_m / 1e-6;
      ASSERT_NEAR(eta, 1e-3 + 2e-3 * in_b, 2e-5) << "sample " << k;
    }
  }
}

double rmsError(const World& world, int rays, double reference) {
  constexpr int kPatterns = 64;
  double sum = 0;
  for (int frame = 0; frame < kPatterns; ++frame) {
    const double error = echoOf(world, beamPlan(world.scene, rays), frame) / reference - 1;
    sum += error * error;
  }
  return std::sqrt(sum / kPatterns);
}

// Plain random points would gain a factor of 2 from four times as many.
TEST(BeamAverageLaw, ErrorsOfASmoothSceneFallFasterThanTheNumberOfRays) {
  const World world = sheetWorld(
      rotated(sheet(1, 0.5, 0), {0, 1, 0}, radiansFromDegrees(20)).moved({0, 0, 0.1}), 40);
  double reference = 0;
  for (int frame = 100; frame < 116; ++frame)
    reference += echoOf(world, beamPlan(world.scene, 4096), frame) / 16;
  double few = 0;
  for (const int rays : {4, 16, 64, 256}) {
    const double error = rmsError(world, rays, reference);
    std::printf("%d rays: RMS error %.2g\n", rays, error);
    if (few > 0) {
      EXPECT_LT(error, few * std::pow(4.0, -0.9)) << rays;
    }
    few = error;
  }
}

// What is random is hashed from frame and line, never drawn in the order of the work.
TEST(BeamAverageLaw, ThreadsChangeNoBitAndFramesChangeThePattern) {
  World world = randomWorld(7);
  world.scene.probe.lines = 37;
  const EffectPlan plan = beamPlan(world.scene, 5);
  PolarFrame one;
  for (const int threads : {1, 2, 7})
    withThreads(threads, [&] {
      const PolarFrame polar = traceWorld(world, plan, Tracer::embree, 3);
      if (threads == 1) one = polar;
      EXPECT_EQ(polar.planes, one.planes);
      EXPECT_EQ(polar.intensities, one.intensities);
      EXPECT_EQ(polar.medium, one.medium);
    });
  const World edge = sheetWorld(rectangle(0, 0.5, -0.5, 0.5, 0.08));
  const EffectPlan many = beamPlan(edge.scene, 8);
  EXPECT_NE(traceWorld(edge, many, Tracer::embree, 0).planes,
            traceWorld(edge, many, Tracer::embree, 1).planes);
}

}  // namespace
}  // namespace echocine
