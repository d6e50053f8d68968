// Only the effects that a scene calls for, each with its reason.

#include "plan/effect_plan.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/plain_scene.h"

namespace echocine {
namespace {

using namespace support;

Scene sceneOf(const Medium& outside, const Medium& inside) {
  Scene scene = plainScene({outside, inside});
  addStructure(scene, 1, 1);
  return scene;
}

const Medium kPlain = medium("plain", 1000, 1500, 5, 0.1);

EffectDecision decision(const Scene& scene, const std::string& name) {
  for (const EffectDecision& d : planEffects(scene).decisions)
    if (d.name() == name) return d;
  return {};
}

TEST(EffectPlan, EveryEffectIsDecidedWithAReason) {
  const EffectPlan plan = planEffects(sceneOf(kPlain, medium("other", 1100, 1600, 5, 0.1)));
  std::vector<std::string> names;
  for (const EffectDecision& d : plan.decisions) {
    names.push_back(d.name());
    EXPECT_FALSE(d.reason.empty()) << d.name();
  }
  for (const char* name : {"reflection", "transmission_loss", "refraction", "attenuation",
                           "backscatter", "travel_time"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
}

TEST(EffectPlan, EqualMediaNeedNeitherEchoesNorLossesNorBending) {
  const EffectPlan plan = planEffects(sceneOf(kPlain, medium("twin", 1000, 1500, 9, 0.3)));
  EXPECT_FALSE(plan.reflection || plan.transmission_loss || plan.refraction);
  EXPECT_TRUE(plan.backscatter && plan.attenuation);
}

TEST(EffectPlan, EqualSpeedsNeedNoBending) {
  const Scene scene = sceneOf(kPlain, medium("dense", 1100, 1500, 5, 0.1));
  EXPECT_TRUE(decision(scene, "reflection").on);
  EXPECT_FALSE(decision(scene, "refraction").on);
  EXPECT_NE(decision(scene, "refraction").reason.find("speed"), std::string::npos);
}

TEST(EffectPlan, EqualImpedanceAndUnlikeSpeedsReflectAndBend) {
  const EffectPlan plan = planEffects(sceneOf(kPlain, medium("odd", 1000 * 1500 / 1600.0, 1600)));
  EXPECT_TRUE(plan.reflection && plan.refraction);
}

TEST(EffectPlan, AMembraneOfAnotherSpeedReflectsButBendsNothing) {
  Scene scene = sceneOf(kPlain, kPlain);
  scene.media[1] = medium("leaflet", 1120, 1640);
  scene.structures[0].membrane = true;
  EXPECT_TRUE(decision(scene, "reflection").on);
  EXPECT_FALSE(decision(scene, "refraction").on);
}

TEST(EffectPlan, NamesTheStructureThatBends) {
  const Scene scene = sceneOf(kPlain, medium("fast", 1000, 1700));
  const std::string reason = decision(scene, "refraction").reason;
  EXPECT_NE(reason.find("structure_0"), std::string::npos) << reason;
  EXPECT_NE(reason.find("1700"), std::string::npos) << reason;
}

TEST(EffectPlan, PerfectGainWithoutIntensitiesNeedsNoAttenuation) {
  Scene scene = sceneOf(kPlain, kPlain);
  scene.output.exr = false;
  EXPECT_FALSE(decision(scene, "attenuation").on);
  EXPECT_NE(decision(scene, "attenuation").reason.find("TGC"), std::string::npos);
  scene.signal.tgc = Tgc::none;
  EXPECT_TRUE(decision(scene, "attenuation").on);
}

TEST(EffectPlan, AttenuationIsOnForEveryChannelThatHoldsIt) {
  for (const Channel channel :
       {Channel::y, Channel::attenuation, Channel::reflection, Channel::backscatter}) {
    Scene scene = sceneOf(kPlain, kPlain);
    scene.output.channels = {channel};
    EXPECT_TRUE(decision(scene, "attenuation").on) << channelName(channel);
  }
  for (const Channel channel : {Channel::unattenuated, Channel::medium, Channel::display}) {
    Scene scene = sceneOf(kPlain, kPlain);
    scene.output.channels = {channel};
    EXPECT_FALSE(decision(scene, "attenuation").on) << channelName(channel);
  }
}

TEST(EffectPlan, NothingToAttenuateAndNothingToScatter) {
  const Scene scene = sceneOf(medium("a", 1000, 1500), medium("b", 1100, 1500));
  EXPECT_FALSE(decision(scene, "attenuation").on);
  EXPECT_FALSE(decision(scene, "backscatter").on);
}

TEST(EffectPlan, TheSceneHasTheLastWord) {
  Scene scene = sceneOf(kPlain, medium("fast", 1000, 1700));
  scene.effects.refraction = Switch::off;
  scene.effects.travel_time = Switch::on;
  EXPECT_FALSE(decision(scene, "refraction").on);
  EXPECT_NE(decision(scene, "refraction").reason.find("although"), std::string::npos);
  EXPECT_TRUE(planEffects(scene).travel_time);
  EXPECT_FALSE(planEffects(sceneOf(kPlain, kPlain)).travel_time);
}

// Two lines are enough for what acts across lines; one line has no neighbour.
TEST(EffectPlan, DropoutAndHazeNeedTwoLines) {
  Scene scene = sceneOf(kPlain, medium("other", 1100, 1600, 5, 0.1));
  scene.output.cine = true;
  scene.artefacts.dropout = scene.artefacts.haze = true;
  for (const int lines : {1, 2}) {
    scene.probe.lines = lines;
    for (const char* effect : {"dropout", "haze"}) {
      EXPECT_EQ(decision(scene, effect).on, lines == 2) << effect << ", " << lines;
      EXPECT_EQ(decision(scene, effect).reason == "there is only one line", lines == 1) << effect;
    }
  }
}

TEST(EffectPlanOfBeams, SeveralRaysSpreadOverWhatIsNotTurnedOff) {
  Scene scene = sceneOf(medium("a", 1000, 1540, 1, 1e-3), medium("b", 1100, 1540, 1, 1e-3));
  EffectPlan plan = planEffects(scene);
  EXPECT_EQ(plan.rays_per_beam, 1);
  EXPECT_FALSE(plan.elevation || plan.lateral_rays);
  scene.accuracy.rays_per_beam = 12;
  plan = planEffects(scene);
  EXPECT_EQ(plan.rays_per_beam, 12);
  EXPECT_TRUE(plan.elevation && plan.lateral_rays && plan.beam_width);
  scene.effects.elevation = Switch::off;
  plan = planEffects(scene);
  EXPECT_TRUE(plan.lateral_rays && !plan.elevation);
  scene.effects.elevation = Switch::automatic;
  scene.signal.beam_width = BeamWidth::none;
  plan = planEffects(scene);
  EXPECT_TRUE(plan.elevation && !plan.lateral_rays);
  scene.output.cine = false;
  scene.output.channels = {Channel::medium};
  plan = planEffects(scene);
  EXPECT_EQ(plan.rays_per_beam, 1);
  EXPECT_EQ(plan.decision(Effect::elevation).reason, "no requested output contains intensities");
}

// Rays are drawn across the plane themselves, so slices give way to them.
TEST(EffectPlanOfBeams, SlicesStandForABeamOfOneRay) {
  Scene scene = sceneOf(medium("a", 1000, 1540, 1, 1e-3), medium("b", 1100, 1540, 1, 1e-3));
  scene.accuracy.elevation_slices = 5;
  EffectPlan plan = planEffects(scene);
  EXPECT_EQ(plan.elevation_slices, 5);
  EXPECT_TRUE(plan.decision(Effect::elevation).on);
  EXPECT_FALSE(plan.elevation);
  scene.effects.elevation = Switch::off;
  EXPECT_EQ(planEffects(scene).elevation_slices, 1);
  scene.effects.elevation = Switch::automatic;
  scene.accuracy.rays_per_beam = 12;
  plan = planEffects(scene);
  EXPECT_EQ(plan.elevation_slices, 1);
  EXPECT_TRUE(plan.elevation);
  scene.accuracy.rays_per_beam = 1;
  scene.output.cine = false;
  scene.output.channels = {Channel::medium};
  EXPECT_EQ(planEffects(scene).elevation_slices, 1);
}

}  // namespace
}  // namespace echocine
