// Thousands of random worlds: whatever the scene, the image is finite, not negative and within what
// the laws allow, and both tracers agree on it.
//
// ECHOCINE_RANDOM_SCENES sets how many; a failure names the world's number, which is all that is
// needed to make it again.

#include <gtest/gtest.h>

#include <chrono>

#include "signal/signal_chain.h"
#include "support/random_world.h"

namespace echocine {
namespace {

using namespace support;

#ifdef NDEBUG
constexpr std::uint64_t kScenes = 10000;
#else
constexpr std::uint64_t kScenes = 500;
#endif

std::uint64_t sceneCount() {
  const char* asked = std::getenv("ECHOCINE_RANDOM_SCENES");
  return asked ? std::strtoull(asked, nullptr, 10) : kScenes;
}

// Calls check(world) for every number, on one core, until three worlds have failed.
template <typename Check>
void forRandomWorlds(std::uint64_t count, Check&& check) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  double slowest_s = 0;
  int failed = 0;
  withThreads(1, [&] {
    for (std::uint64_t i = 0; i < count && failed < 3; ++i) {
      SCOPED_TRACE("random world " + std::to_string(i));
      const auto began = Clock::now();
      check(randomWorld(i), i);
      slowest_s = std::max(slowest_s, std::chrono::duration<double>(Clock::now() - began).count());
      const auto* result = testing::UnitTest::GetInstance()->current_test_info()->result();
      failed = result->total_part_count();
    }
  });
  EXPECT_LT(slowest_s, 5);  // seconds; they take milliseconds: one that hangs shows
  std::printf("%llu random worlds in %.1f s, the slowest %.3f s\n",
              static_cast<unsigned long long>(count),
              std::chrono::duration<double>(Clock::now() - start).count(), slowest_s);
}

// The number of values that are no intensity.
std::size_t unusable(const std::vector<float>& values) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](float v) {
    return !(v >= 0 && v <= std::numeric_limits<float>::max());
  }));
}

void expectIntensities(const World& world, const PolarFrame& polar) {
  for (const auto& [channel, plane] : polar.planes)
    EXPECT_EQ(unusable(plane), 0u) << channelName(channel);
  EXPECT_EQ(unusable(polar.intensities.values), 0u) << "signal";
  for (const std::uint32_t id : polar.medium)
    ASSERT_TRUE(id == kNoMedium || id < world.scene.media.size()) << id;
}

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

// Time gain, beam, compression and scan conversion of whatever was traced. The brightest sample is
// the reference: the loop's percentile has tests of its own and costs more than all the rest here.
void expectPicture(const World& world, const EffectPlan& plan, PolarFrame& polar) {
  const SignalChain chain(world.scene, plan);
  chain.process(polar.intensities);
  EXPECT_EQ(unusable(polar.intensities.values), 0u) << "after the signal chain";
  const double brightest = *std::max_element(polar.intensities.begin(), polar.intensities.end());
  const Greys greys = chain.compress(std::move(polar.intensities), brightest > 0 ? brightest : 1);
  for (const float grey : greys) ASSERT_TRUE(grey >= 0 && grey <= 1) << grey;
  GreyImage image;
  chain.picture(greys, image);
  EXPECT_EQ(image.pixels.size(), 24u * 20u);
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

// Averages of lawful rays: what one ray cannot exceed no average can. The channels say what the
// picture says: reflection and backscatter make Y, and unattenuated is no less.
void expectLawfulBeams(const World& world, const EffectPlan& plan, const PolarFrame& polar) {
  expectIntensities(world, polar);
  double gain = 0, scattered = 0;
  for (const Structure& s : world.scene.structures) gain = std::max(gain, s.reflection_gain);
  for (const Medium& m : world.scene.media) scattered = std::max(scattered, m.backscatter_per_m_sr);
  const auto plane = [&](Channel c) -> const std::vector<float>& { return polar.planes.at(c); };
  const Probe& probe = world.scene.probe;
  const auto samples = static_cast<std::size_t>(probe.samples);
  for (std::size_t k = 0; k < polar.planes.at(Channel::y).size(); ++k) {
    const double y = plane(Channel::y)[k], echo = plane(Channel::reflection)[k],
                 scatter = plane(Channel::backscatter)[k];
    ASSERT_NEAR(y, echo + scatter, 1e-5 * (echo + scatter)) << k;
    ASSERT_LE(y, plane(Channel::unattenuated)[k] * (1 + 1e-5)) << k;
    if (plan.transmission_loss) {
      ASSERT_LE(echo, gain * planeRequest(world.scene, plan).echo_samples * (1 + 1e-5)) << k;
    }
    const double l = samplingOf(probe).centre(static_cast<double>(k % samples));
    // With travel times depth is not path: speeds here are up to 1e5, down to 10 m/s.
    if (!plan.travel_time && plan.spread) {
      ASSERT_LE(scatter * l * l, scattered * world.scene.unit_volume_m3 * (1 + 1e-5)) << k;
    }
  }
}

// Beams of a few rays, and those of one line and frame the same through any number of threads.
TEST(RandomScenes, BeamsOfSeveralRaysAreFiniteAndWithinTheEnergyOfThePulse) {
  forRandomWorlds(sceneCount() / 2, [](World world, std::uint64_t number) {
    Dice dice(hashOf(std::uint64_t{0xbea}, number));
    randomBeam(world.scene, dice);
    const EffectPlan plan = planEffects(world.scene);
    if (plan.rays_per_beam == 1) return;
    const int frame = dice.whole(0, 1000);
    PolarFrame polar = traceWorld(world, plan, Tracer::embree, frame);
    expectLawfulBeams(world, plan, polar);
    expectPicture(world, plan, polar);
    // Labels and exponents are those of the line.
    EffectPlan one = plan;
    one.rays_per_beam = 1;
    const PolarFrame line = traceWorld(world, one, Tracer::embree);
    EXPECT_EQ(polar.medium, line.medium);
    EXPECT_EQ(polar.planes.at(Channel::attenuation), line.planes.at(Channel::attenuation));
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
    // One pulse holds it together with up to seven before it; and one rounding of the mesh to
    // float.
    const double pulse_m = settings.pulse_cycles * settings.wavelength_m / 2;
    const double safe_m = z_m - 7 * pulse_m - settings.thin_layer_m - 1e-7;
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
