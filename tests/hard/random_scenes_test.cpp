// Thousands of random worlds: whatever the scene, the image is finite, not negative and within what
// the laws allow, and both tracers agree on it.
//
// ECHOCINE_RANDOM_SCENES sets how many; a failure names the world's number, which is all that is
// needed to make it again.

#include <gtest/gtest.h>

#include "support/random_checks.h"

namespace echocine {
namespace {

using namespace support;

// Segments follow each other without a gap to the end, their lengths and exponents grow, and what
// is left of the pulse (prod (1-R)^2, the strength over eta_b V) only falls and never exceeds 1.
// Behind a thin layer there may be more than inside it: what its first face sends back its second
// takes up again.
void expectOrderedSegments(const World& world, const TraceSettings& settings,
                           const LineTrace& line) {
  double depth = 0, path = 0, exponent = 0, left = 1;
  for (const MediumSegment& s : line.segments) {
    ASSERT_EQ(s.begin_depth_m, depth);
    ASSERT_GE(s.end_depth_m, s.begin_depth_m);
    ASSERT_GE(s.begin_path_m, path);
    ASSERT_GE(s.begin_exponent, exponent);
    depth = s.end_depth_m;
    path = s.begin_path_m;
    exponent = s.begin_exponent;
    const double full =
        settings.media[index(s.medium)].backscatter_per_m_sr * world.scene.unit_volume_m3;
    if (full == 0 || !settings.backscatter) continue;
    ASSERT_LE(s.strength_m2_sr / full, left * (1 + 1e-12));
    ASSERT_GE(s.strength_m2_sr, 0);
    if (!settings.thin_layers) left = s.strength_m2_sr / full;
  }
  ASSERT_LE(depth, world.scene.probe.max_depth_m);
}

// (1-R)^2 <= 1-R, so with losses on, the echoes of a line are parts of one pulse: with gains up to
// g they add to at most g. Without losses each one alone stays below g.
void expectEnergy(const World& world, const TraceSettings& settings, const LineTrace& line) {
  double gain = 0, sum = 0;
  for (const Structure& s : world.scene.structures) gain = std::max(gain, s.reflection_gain);
  for (const Echo& echo : line.echoes) {
    ASSERT_GE(echo.intensity, 0);
    ASSERT_GE(echo.exponent, 0);
    ASSERT_LE(echo.intensity, 2 * gain * (1 + 1e-12));
    sum += echo.intensity;
  }
  if (settings.transmission_loss) {
    ASSERT_LE(sum, gain * (1 + 1e-9));
  }
}

// Cells hold several edges of contour, each with an echo of its own.
void expectCellEchoes(const World& world, const PolarFrame& polar) {
  double gain = 0;
  for (const Structure& s : world.scene.structures) gain = std::max(gain, s.reflection_gain);
  const CellEchoes& echoes = polar.cell_echoes;
  const auto samples =
      static_cast<std::size_t>(polar.lines) * static_cast<std::size_t>(polar.samples);
  for (std::size_t i = 0; i < echoes.count; ++i) {
    ASSERT_GE(echoes.intensity[i], 0);
    ASSERT_GE(echoes.exponent[i], 0);
    ASSERT_LE(echoes.intensity[i], 2 * gain * (1 + 1e-12));  // a membrane's two within a cell
    ASSERT_LT(echoes.at[i], samples);
  }
}

void expectLawful(const World& world, const EffectPlan& plan, Tracer tracer,
                  const PolarFrame& polar) {
  expectIntensities(world, polar);
  const TraceSettings settings(world.scene, plan,
                               tracer == Tracer::cells ? EchoCells::contours : EchoCells::none);
  for (const LineTrace& line : polar.traces) {
    expectOrderedSegments(world, settings, line);
    expectEnergy(world, settings, line);
    if (testing::Test::HasFatalFailure()) return;
    if (settings.cells != EchoCells::none) {
      EXPECT_TRUE(line.echoes.empty());
    }
  }
  expectCellEchoes(world, polar);
}

// To the last bit: both geometries decide by the same numbers.
void expectSameImage(const PolarFrame& sliced, const PolarFrame& traced) {
  for (const auto& [channel, plane] : sliced.planes)
    EXPECT_EQ(plane, traced.planes.at(channel)) << channelName(channel);
  EXPECT_EQ(sliced.medium, traced.medium);
  EXPECT_EQ(sliced.intensities, traced.intensities);
}

// Energy: a line's echoes and backscatter cannot bring back more than was sent, whatever stands in
// its way.
TEST(RandomScenes, AreFiniteWithinTheEnergyOfThePulseAndTheSameThroughBothTracers) {
  forRandomWorlds(sceneCount(), [](const World& world, std::uint64_t number) {
    const EffectPlan plan = planEffects(world.scene);
    EffectPlan straight = plan;
    straight.refraction = false;
    PolarFrame sliced = traceWorld(world, straight, Tracer::slice);
    PolarFrame traced = traceWorld(world, straight, Tracer::embree);
    expectLawful(world, straight, Tracer::slice, sliced);
    expectSameImage(sliced, traced);
    if (plan.refraction) {
      SCOPED_TRACE("refracted");
      traced = traceWorld(world, plan, Tracer::embree);
      expectLawful(world, plan, Tracer::embree, traced);
    }
    PolarFrame& shown = number % 2 == 0 ? sliced : traced;
    if (plan.reflection && world.scene.probe.lines > 1) {
      SCOPED_TRACE("cells");
      sliced = traceWorld(world, straight, Tracer::cells);
      expectLawful(world, straight, Tracer::cells, sliced);
    }
    expectPicture(world, plan, shown);
  });
}

// A box all of which lies deeper than `z_m` below the face, whatever the probe, over everything.
World withDeeperBox(const World& world, double z_m, Dice& dice) {
  World more = world;
  const double front = z_m + world.scene.probe.face_radius_m;
  more.meshes.push_back(box({-1, -1, front}, {1, 1, front + dice.decade(1e-4, 1)}));
  addStructure(
      more.scene,
      static_cast<std::size_t>(dice.whole(0, static_cast<int>(world.scene.media.size()) - 1)),
      1000);
  if (!world.normals.empty()) more.normals.emplace_back(8, Vec3f{0, 0, 0});
  return more;
}

// What is added deeper reaches no shallower sample: every straight or bent path to it is longer.
// Integration over the beam's cell is left out: it takes the losses of an edge from where the
// line's centre passes the same surface, which for a steep wall may be deeper than the edge.
// Causality: what comes back sooner cannot know of it.
TEST(RandomScenes, ADeeperInterfaceChangesNothingShallower) {
  forRandomWorlds(sceneCount() / 4, [](const World& world, std::uint64_t number) {
    Dice dice(hashOf(std::uint64_t{0xdee9}, number));
    const Probe& probe = world.scene.probe;
    const double z_m = dice.number(0.2, 1.2) * probe.max_depth_m;
    const World more = withDeeperBox(world, z_m, dice);
    EffectPlan plan = planEffects(more.scene);  // of both: it decides for the same media
    plan.travel_time = false;                   // depth is path length
    const TraceSettings settings(world.scene, plan);
    // A stack of layers ends after 48 lengths of the pulse; and one rounding of the mesh to float.
    const double pulse_m = settings.pulse_cycles * settings.wavelength_m / 2;
    const double safe_m = z_m - 48 * pulse_m - settings.thin_layer_m - 1e-7;
    const double shallow = (safe_m - probe.min_depth_m) / probe.sampleSpacing();
    const auto same = static_cast<std::size_t>(
        std::clamp(std::floor(shallow), 0.0, static_cast<double>(probe.samples)));
    for (const Tracer tracer : {Tracer::slice, Tracer::embree}) {
      SCOPED_TRACE(nameOf(tracer));
      const std::vector<float> before = traceWorld(world, plan, tracer).planes.at(Channel::y);
      const std::vector<float> after = traceWorld(more, plan, tracer).planes.at(Channel::y);
      const auto samples = static_cast<std::size_t>(probe.samples);
      for (std::size_t begin = 0; begin < before.size(); begin += samples)
        for (std::size_t k = begin; k < begin + same; ++k)
          ASSERT_EQ(before[k], after[k]) << "line " << begin / samples << ", sample " << k - begin;
    }
  });
}

// What the plan leaves out of a picture nobody can see: forced on, it gives the same bytes.
// Refraction and travel time are other pictures.
TEST(RandomScenes, EverythingForcedOnIsThePictureOfThePlan) {
  forRandomWorlds(8, [](World world, std::uint64_t) {
    world.scene.output.channels.clear();
    world.scene.output.cine = true;
    EffectSwitches& switches = world.scene.effects;
    switches = {};
    switches.refraction = Switch::off;
    const PolarFrame planned = traceWorld(world, Tracer::slice);
    for (Switch* s : {&switches.reflection, &switches.lobe, &switches.transmission_loss,
                      &switches.attenuation, &switches.backscatter, &switches.spread,
                      &switches.snell_angles, &switches.reflection_cap, &switches.thin_layers})
      *s = Switch::on;
    const PolarFrame forced = traceWorld(world, Tracer::slice);
    EXPECT_EQ(planned.intensities, forced.intensities);
  });
}

}  // namespace
}  // namespace echocine
