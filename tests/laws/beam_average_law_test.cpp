// What several rays per beam make of a scene, against closed forms of the beam's profile.

#include <gtest/gtest.h>

#include <numeric>

#include "scene/beam_profile.h"
#include "scene/scan_geometry.h"
#include "signal/signal_chain.h"
#include "support/random_world.h"

namespace echocine {
namespace {

using namespace support;

EffectPlan beamPlan(const Scene& scene, int rays, bool lateral = true, bool elevation = true) {
  Scene asked = scene;
  asked.accuracy.rays_per_beam = rays;
  asked.effects.elevation = elevation ? Switch::automatic : Switch::off;
  EffectPlan plan = planEffects(asked);
  plan.lateral_rays = lateral;
  plan.refraction = false;
  return plan;
}

// One line along z in water, samples of a tenth of a millimetre, and a thin sheet that sends the
// same back at every angle unless its exponent says otherwise.
World sheetWorld(const Mesh& mesh, double exponent = 0) {
  World world{plainScene({medium("water", 1000, 1540, 0, 1e-3), medium("sheet", 1100, 1540)}),
              {mesh}};
  addStructure(world.scene, 1, 0, true);
  world.scene.structures[0].reflection_exponent = exponent;
  world.scene.probe.samples = 1600;
  world.scene.probe.elevation_focus_m = 0.07;
  world.scene.output.channels = {Channel::reflection};
  world.scene.output.cine = false;
  return world;
}

double sumOf(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double echoOf(const World& world, const EffectPlan& plan, int frame = 0) {
  return sumOf(traceWorld(world, plan, Tracer::embree, frame).planes.at(Channel::reflection));
}

// What one ray meets of a sheet across it.
double wholeEcho(const World& world) {
  World across = world;
  across.meshes = {sheet(1, 0.5, 0.08)};
  EffectPlan plan = planEffects(world.scene);
  plan.refraction = false;
  return echoOf(across, plan);
}

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

// Relative variation of a wall's echo over the depths that it spans, 10 degrees to the beams.
double steepVariation(int rays) {
  World world =
      sheetWorld(rotated(sheet(1, 0.5, 0), {0, 1, 0}, radiansFromDegrees(80)).moved({0, 0, 0.08}));
  Probe& p = world.scene.probe;
  p.kind = ProbeKind::linear;
  p.first_angle_rad = p.last_angle_rad = 0;
  p.first_offset_m = -0.01;
  p.last_offset_m = 0.01;
  p.lines = 41;
  p.samples = 320;
  const PolarFrame polar =
      traceWorld(world, beamPlan(world.scene, rays, true, false), Tracer::embree);
  double sum = 0, squares = 0;
  constexpr std::size_t kFrom = 120, kTo = 200;  // 60 to 100 mm, where inner lines meet it
  for (std::size_t k = kFrom; k < kTo; ++k) {
    double echo = 0;
    for (std::size_t line = 0; line < 41; ++line)
      echo += static_cast<double>(polar.planes.at(Channel::reflection)[line * 320 + k]);
    sum += echo;
    squares += echo * echo;
  }
  const double mean = sum / (kTo - kFrom);
  return std::sqrt(squares / (kTo - kFrom) / (mean * mean) - 1);
}

// Spread over its stratum each ray covers the depths between its neighbours, so gaps close long
// before rays are dense.
TEST(BeamAverageLaw, ASteepWallsEchoVariesLessTheMoreRaysThereAre) {
  const double one = steepVariation(1), few = steepVariation(8), many = steepVariation(128);
  std::printf("variation with 1, 8, 128 rays: %.2f, %.3f, %.4f\n", one, few, many);
  EXPECT_GT(one, 1);  // a string of beads
  EXPECT_LT(few, 0.15);
  EXPECT_LT(many, 0.02);
}

// One line and a wall 10 degrees to it: what comes back from each depth is the two-way beam's share
// that meets the wall there, the bell at the slope S(z) = (z - z_0) / (z tan 80) times dS/dz.
TEST(BeamAverageLaw, ASteepWallShowsTheBeamsProfileAlongTheDepth) {
  constexpr double z_0 = 0.08;
  const double tan_80 = std::tan(radiansFromDegrees(80));
  const World world =
      sheetWorld(rotated(sheet(1, 0.5, 0), {0, 1, 0}, radiansFromDegrees(-80)).moved({0, 0, z_0}));
  const Probe& p = world.scene.probe;
  const double whole = wholeEcho(world);
  const std::vector<float> echo =
      traceWorld(world, beamPlan(world.scene, 64, true, false), Tracer::embree)
          .planes.at(Channel::reflection);
  const Sampling sampling = samplingOf(p);
  double difference = 0, sum = 0;
  for (std::size_t k = 400; k < 1200; ++k) {  // 40 to 120 mm
    const double z = sampling.centre(static_cast<double>(k));
    const double sigma =
        focusedBeamWidth(z, p.aperture_m, p.focus_m, ScanGeometry(p).wavelength()) /
        kWidthPerDeviation / z;
    const double slope = (z - z_0) / (z * tan_80), per_depth = z_0 / (z * z * tan_80);
    const double bell =
        std::exp(-slope * slope / (2 * sigma * sigma)) / (sigma * std::sqrt(2 * std::numbers::pi));
    const double expected = bell * per_depth * sampling.spacing_m;
    difference += std::abs(static_cast<double>(echo[k]) / whole - expected);
    sum += expected;
  }
  std::printf("difference from the beam's profile: %.3f of %.3f\n", difference, sum);
  EXPECT_NEAR(sum, 1, 0.05);  // the beam widens with depth
  EXPECT_LT(difference, 0.06);
}

// On walls that are smooth over a beam both ways of taking its average mean the same.
// Where walls run across the beam, the paper's average and the traced beam must say the same.
TEST(BeamAverageLaw, TheFilterAgreesWithTheRaysOnASmoothWallAtTheFocus) {
  World world{plainScene({medium("water", 1000, 1540), medium("wall", 1100, 1540)}),
              {icosphere(5, 0.1).moved({0.02, 0, 0.18})}};
  addStructure(world.scene, 1, 0);
  world.scene.structures[0].reflection_exponent = 2;
  world.scene.probe.lines = 129;
  world.scene.probe.samples = 640;
  world.scene.effects.elevation = Switch::off;
  const auto shown = [&](int rays) {
    const EffectPlan plan = beamPlan(world.scene, rays, true, false);
    PolarFrame polar = traceWorld(world, plan, Tracer::embree);
    SignalChain(world.scene, plan).process(polar.intensities);
    return polar.intensities.values;
  };
  const std::vector<float> filtered = shown(1), rays = shown(256);
  double worst_db = 0;
  for (std::size_t line = 50; line < 90; ++line) {
    const auto echo = [&](const std::vector<float>& signal) {
      const auto begin = signal.begin() + static_cast<std::ptrdiff_t>(line * 640);
      return std::accumulate(begin, begin + 480, 0.0);  // to 120 mm: the front alone
    };
    worst_db = std::max(worst_db, std::abs(10 * std::log10(echo(filtered) / echo(rays))));
  }
  std::printf("filter against rays: %.3f dB at most\n", worst_db);
  EXPECT_LT(worst_db, 0.2);
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
