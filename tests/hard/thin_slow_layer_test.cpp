// Straight rays through a thin slow layer met at a steep angle: against rays that bend.

#include <gtest/gtest.h>

#include <numeric>

#include "scene/scan_geometry.h"
#include "support/plain_scene.h"
#include "support/world.h"

namespace echocine {
namespace {

using namespace support;

// A linear probe over tissue with a sheet or shell of fat.
World fatWorld(const Mesh& outer, const std::vector<Mesh>& inner) {
  World world;
  world.scene =
      plainScene({medium("tissue", 1060, 1584, 0, 1e-3), medium("fat", 927, 1462, 0, 1e-3)});
  Probe& probe = world.scene.probe;
  probe.kind = ProbeKind::linear;
  probe.first_angle_rad = probe.last_angle_rad = 0;
  probe.first_offset_m = -0.02;
  probe.last_offset_m = 0.02;
  probe.max_depth_m = 0.1;
  probe.frequency_hz = 5e6;
  probe.lines = 128;
  probe.samples = 1024;
  world.scene.output.channels = {Channel::backscatter};
  world.scene.effects.attenuation = Switch::off;
  world.scene.effects.spread = Switch::off;
  addStructure(world.scene, 1, 1);
  world.meshes = {outer};
  for (const Mesh& mesh : inner) {
    addStructure(world.scene, 0, 2);
    world.meshes.push_back(mesh);
  }
  return world;
}

struct Difference {
  double unequal = 0;  // share of samples that are lit in one alone
  double rms_db = 0;   // of those that are lit in both
};

Difference between(const World& world, Tracer straight) {
  EffectPlan plan = planEffects(world.scene);
  plan.refraction = true;
  const PolarFrame bent = traceWorld(world, plan, Tracer::embree);
  plan.refraction = false;
  const PolarFrame other = traceWorld(world, plan, straight);
  const std::vector<float>&a = bent.planes.at(Channel::backscatter),
        &b = other.planes.at(Channel::backscatter);
  Difference found;
  double both = 0, squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if ((a[i] > 0) != (b[i] > 0)) found.unequal += 1.0 / static_cast<double>(a.size());
    if (!(a[i] > 0 && b[i] > 0)) continue;
    const double db = 10 * std::log10(static_cast<double>(a[i] / b[i]));
    squares += db * db;
    both += 1;
  }
  found.rms_db = std::sqrt(squares / both);
  return found;
}

// A sheet of fat, 0.3 mm thick, whose normal stands at 74 degrees to the lines.
Mesh tiltedSheet() {
  const double a = radiansFromDegrees(74);
  Mesh m = box({-0.2, -0.05, 0}, {0.2, 0.05, 0.0003});
  for (Vec3d& p : m.points)
    p = {p.x * std::cos(a) + p.z * std::sin(a), p.y, 0.05 - p.x * std::sin(a) + p.z * std::cos(a)};
  return m;
}

TEST(ThinSlowLayer, AFatSheetAtSeventyFourDegreesLightsWhatBentRaysLight) {
  const World world = fatWorld(tiltedSheet(), {});
  for (const Tracer tracer : {Tracer::slice, Tracer::cells}) {
    const Difference found = between(world, tracer);
    EXPECT_LT(found.unequal, 0.005) << nameOf(tracer);
    EXPECT_LT(found.rms_db, 1) << nameOf(tracer);
  }
}

TEST(ThinSlowLayer, WithoutSnellsDirectionStraightRaysEndWhereNoBentRayDoes) {
  World world = fatWorld(tiltedSheet(), {});
  world.scene.effects.snell_angles = Switch::off;
  EXPECT_GT(between(world, Tracer::slice).unequal, 0.2);
}

// An epicardium: a shell of fat, 0.5 mm thick, round a ball.
TEST(ThinSlowLayer, AShellOfFat) {
  const Mesh outer = icosphere(6, 0.0155).moved({0, 0, 0.05}),
             inner = icosphere(6, 0.015).moved({0, 0, 0.05});
  const Difference found = between(fatWorld(outer, {inner}), Tracer::slice);
  RecordProperty("unequal", std::to_string(found.unequal));
  EXPECT_LT(found.unequal, 0.02);
  EXPECT_LT(found.rms_db, 1);
}

// RMS over lines near the middle of the difference of their echoes' sums, straight against bent,
// dB.
double echoDifference(const World& world, double within_m) {
  EffectPlan plan = planEffects(world.scene);
  plan.refraction = true;
  const PolarFrame bent = traceWorld(world, plan, Tracer::embree);
  plan.refraction = false;
  const PolarFrame straight = traceWorld(world, plan, Tracer::slice);
  const auto sumOf = [&](const PolarFrame& frame, int line) {
    const auto first = frame.planes.at(Channel::reflection).begin() + line * 1024;
    return std::accumulate(first, first + 1024, 0.0);
  };
  double squares = 0, lines = 0;
  for (int line = 0; line < world.scene.probe.lines; ++line) {
    if (std::abs(lineGeometry(world.scene.probe, line).origin.x) > within_m) continue;
    const double a = sumOf(bent, line), b = sumOf(straight, line);
    if (!(a > 0 && b > 0)) continue;
    squares += std::pow(10 * std::log10(a / b), 2);
    lines += 1;
  }
  return std::sqrt(squares / lines);
}

// The same shell's echoes. Rays that graze its limb leave it elsewhere when they bend.
TEST(ThinSlowLayer, AShellsEchoesAreThoseOfBentRaysButAtItsLimb) {
  constexpr double kRadius_m = 0.015;
  for (const double f : {2.5e6, 5e6})
    for (const double thickness_m : {0.3e-3, 0.5e-3}) {
      SCOPED_TRACE(testing::Message() << f << " Hz, " << thickness_m << " m");
      World world = fatWorld(icosphere(6, kRadius_m + thickness_m).moved({0, 0, 0.05}),
                             {icosphere(6, kRadius_m).moved({0, 0, 0.05})});
      world.scene.probe.frequency_hz = f;
      world.scene.output.channels = {Channel::reflection};
      EXPECT_LT(echoDifference(world, kRadius_m * std::sin(radiansFromDegrees(75))), 0.25);
      EXPECT_LT(echoDifference(world, kRadius_m + thickness_m), 2);
    }
}

}  // namespace
}  // namespace echocine
