// What interfaces send back in phase: Rice's statistics on tissue's speckle.

#include <gtest/gtest.h>

#include <numbers>

#include "signal/signal_chain.h"
#include "support/beam_world.h"
#include "support/speckle_bed.h"

namespace echocine {
namespace {

using namespace support;

// Echoes that make the part K / (1 + K) of even intensities, of one phase.
CoherentEchoes coherentOf(std::size_t size, double K, double phase_rad = 0.4) {
  const auto part = static_cast<float>(K / (1 + K));
  return {std::vector<float>(size, part),
          std::vector<float>(size, part * static_cast<float>(std::cos(phase_rad))),
          std::vector<float>(size, part * static_cast<float>(std::sin(phase_rad)))};
}

// Intensity of a constant phasor on a random one, K their powers' ratio: mean over deviation is
// (1 + K) / sqrt(1 + 2 K) (Goodman, "Speckle Phenomena in Optics", 2007, section 3.2.2).
TEST(CoherentEchoLaw, IntensitiesAreRicesOfTheShare) {
  for (const double K : {0.0, 0.5, 2.0, 4.0, 1e9}) {
    SpeckleBed bed(ProbeKind::phased, 250, 512, 0.04, 0.15);
    double n = 0, i1 = 0, i2 = 0;
    for (bed.settings.seed = 1; bed.settings.seed <= 4; ++bed.settings.seed) {
      std::vector<float> intensities = bed.even();
      bed.speckle().apply(Affine{}, 0, intensities, coherentOf(bed.size(), K));
      for (const float v : intensities) {
        const auto intensity = static_cast<double>(v);
        n += 1;
        i1 += intensity;
        i2 += intensity * intensity;
      }
    }
    const double mean = i1 / n, deviation = std::sqrt(std::max(i2 / n - mean * mean, 0.0));
    EXPECT_NEAR(mean, 1, 0.01) << K;
    EXPECT_NEAR(deviation / mean, std::sqrt(1 + 2 * K) / (1 + K), 0.02) << K;
  }
}

TEST(CoherentEchoLaw, TheMeanOverSeedsIsThePictureWithout) {
  constexpr int kSeeds = 200;
  SpeckleBed bed(ProbeKind::phased, 40, 192, 0.06, 0.09);
  std::vector<double> sum(bed.size());
  for (bed.settings.seed = 1; bed.settings.seed <= kSeeds; ++bed.settings.seed) {
    std::vector<float> with = bed.even(3);
    CoherentEchoes echoes = coherentOf(bed.size(), 2);  // of 1 of 3: a wall on tissue
    bed.speckle().apply(Affine{}, 0.2, with, echoes);
    for (std::size_t i = 0; i < with.size(); ++i) sum[i] += static_cast<double>(with[i]);
  }
  double mean = 0;
  for (const double s : sum) {
    EXPECT_NEAR(s / kSeeds / 3, 1, 0.4);
    mean += s / kSeeds / 3 / static_cast<double>(sum.size());
  }
  EXPECT_NEAR(mean, 1, 0.01);
}

TEST(CoherentEchoLaw, WithoutAShareThePictureIsThatOfSpeckleAlone) {
  const SpeckleBed bed(ProbeKind::phased, 60, 300, 0.04, 0.1);
  const Speckle speckle = bed.speckle();
  const auto with = [&](double K) {
    std::vector<float> intensities = bed.even();
    speckle.apply(Affine{}, 0, intensities, coherentOf(bed.size(), K));
    return intensities;
  };
  // Echoes that are there and have no share, and a share that is seen.
  const std::vector<float> alone = bed.picture(speckle), none = with(0), some = with(1e-2);
  double farthest = 0;
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_NEAR(none[i], alone[i], 1e-5f * alone[i] + 1e-7f);
    farthest = std::max(farthest, std::abs(static_cast<double>(some[i] - alone[i])));
  }
  EXPECT_GT(farthest, 1e-2);
}

// The interface's phase goes with its place, as that of its scatterers: the pattern moves whole.
TEST(CoherentEchoLaw, AMovedWallKeepsItsPattern) {
  SpeckleBed bed(ProbeKind::linear, 60, 400, 0.06, 0.1);
  const Speckle speckle = bed.speckle();
  const double moved_m = 5 * bed.probe.sampleSpacing();
  const auto picture = [&](double shift_m, double phase_m) {
    std::vector<float> intensities = bed.even();
    const EchoPhase phase(phase_m, speckle.spread().wavelength_m);
    speckle.apply(shifted({0, 0, shift_m}), 0, intensities,
                  coherentOf(bed.size(), 2, std::atan2(phase.imaginary, phase.real)));
    return intensities;
  };
  const std::vector<float> before = picture(0, 0.08);
  const Window w{10, 50, 10, 380};
  EXPECT_GT(correlation(before, picture(moved_m, 0.08 + moved_m), 400, w, 0, 5), 0.998);
  EXPECT_LT(correlation(before, picture(moved_m, 0.08), 400, w, 0, 5), 0.9);  // left behind
}

// A wall in water, without backscatter: all that is received is its echo, and the tracer says how
// much of it is coherent.
class CoherentWall : public testing::Test {
 protected:
  static World wall() {
    World world{plainScene({medium("water", 1000, 1540), medium("wall", 1100, 1540)}),
                {icosphere(4, 0.03).moved({0, 0, 0.08})}};
    addStructure(world.scene, 1, 0);
    Scene& scene = world.scene;
    scene.structures[0].coherent_share = 3;
    scene.speckle.on = true;
    scene.signal.interface_limit_db = -40;
    scene.probe.lines = 65;
    scene.probe.samples = 640;
    scene.effects.elevation = Switch::off;
    return world;
  }
};

TEST_F(CoherentWall, EveryTracerTellsItsShareOfTheEcho) {
  const World world = wall();
  EffectPlan plan = planEffects(world.scene);
  ASSERT_TRUE(plan.coherent_echoes);
  for (const int rays : {1, 8}) {
    const EffectPlan asked = rays == 1 ? plan : beamPlan(world.scene, rays, true, false);
    for (const Tracer tracer : kTracers) {
      if (rays > 1 && tracer != Tracer::embree) continue;
      PolarFrame polar = traceWorld(world, asked, tracer);
      ASSERT_EQ(polar.coherent.intensity.size(), polar.intensities.size());
      const SignalChain chain(world.scene, asked);
      chain.process(polar.intensities);
      chain.process(polar.coherent, {0, 65});
      std::size_t echoes = 0;
      for (std::size_t i = 0; i < polar.intensities.size(); ++i) {
        const double whole = static_cast<double>(polar.intensities[i]);
        EXPECT_NEAR(polar.coherent.intensity[i], 0.75 * whole, 1e-5 * whole) << nameOf(tracer);
        echoes += whole > 0 ? 1 : 0;
      }
      EXPECT_GT(echoes, 100u);
    }
  }
}

// Straight along the middle line the wall's front lies at 50 mm.
TEST_F(CoherentWall, ThePhaseIsThatOfTheWallsPlace) {
  const World world = wall();
  const EffectPlan plan = planEffects(world.scene);
  for (const Tracer tracer : kTracers) {
    const PolarFrame polar = traceWorld(world, plan, tracer);
    const Probe& probe = world.scene.probe;
    const double samples = (0.05 - probe.min_depth_m) / probe.sampleSpacing();
    std::size_t found = 0;
    for (int k = static_cast<int>(samples) - 2; k < static_cast<int>(samples) + 3; ++k) {
      const auto at = static_cast<std::size_t>(32 * probe.samples + k);
      if (polar.coherent.intensity[at] == 0) continue;
      ++found;
      const EchoPhase phase(0.05, 1540 / probe.frequency_hz);
      const double size = std::hypot(polar.coherent.real[at], polar.coherent.imaginary[at]);
      const double cosine =
          (polar.coherent.real[at] * phase.real + polar.coherent.imaginary[at] * phase.imaginary) /
          size;
      EXPECT_GT(cosine, 0.8) << nameOf(tracer) << " " << k;  // the cell's wall bends away a little
    }
    EXPECT_GE(found, 1u);
  }
}

TEST_F(CoherentWall, NoShareIsTakenWhereNoneIsAskedFor) {
  World world = wall();
  world.scene.structures[0].coherent_share = 0;
  const EffectPlan plan = planEffects(world.scene);
  EXPECT_FALSE(plan.coherent_echoes);
  EXPECT_TRUE(traceWorld(world, plan, Tracer::cells).coherent.empty());
  world.scene.structures[0].coherent_share = 3;
  world.scene.speckle.on = false;
  EXPECT_FALSE(planEffects(world.scene).coherent_echoes);
}

}  // namespace
}  // namespace echocine
