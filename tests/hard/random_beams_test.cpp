// Thousands of random worlds under beams of several rays, and of several slices across the plane.
// How many and which: random_scenes_test.cpp.

#include <gtest/gtest.h>

#include "support/random_checks.h"

namespace echocine {
namespace {

using namespace support;

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
    ASSERT_NEAR(y, echo + scatter,
                1e-5 * (echo + scatter) + double{std::numeric_limits<float>::min()})
        << k;
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

// Slices across the plane are as finite as the plane, send back no more than the pulse has, and
// leave labels and exponents alone.
TEST(RandomScenes, SlicesAcrossThePlaneAreFiniteAndWithinTheEnergyOfThePulse) {
  forRandomWorlds(sceneCount() / 2, [](World world, std::uint64_t number) {
    Dice dice(hashOf(std::uint64_t{0x511ce}, number));
    randomBeam(world.scene, dice);
    world.scene.accuracy.rays_per_beam = 1;
    world.scene.accuracy.elevation_slices = dice.chance(0.5) ? 3 : 5;
    EffectPlan plan = planEffects(world.scene);
    plan.refraction = false;
    if (plan.elevation_slices == 1) return;
    const bool cells = dice.chance(0.5) && world.scene.probe.lines > 1;
    PolarFrame polar = traceThickWorld(world, plan, cells ? EchoCells::contours : EchoCells::none);
    // An echo over a cell stands in samples of its own, where the bound is another one.
    if (cells)
      expectIntensities(world, polar);
    else
      expectLawfulBeams(world, plan, polar);
    const PolarFrame one = traceWorld(world, plan, cells ? Tracer::cells : Tracer::slice);
    EXPECT_EQ(polar.medium, one.medium);
    EXPECT_EQ(polar.planes.at(Channel::attenuation), one.planes.at(Channel::attenuation));
    expectPicture(world, plan, polar);
  });
}

}  // namespace
}  // namespace echocine
