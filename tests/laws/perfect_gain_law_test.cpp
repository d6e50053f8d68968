// Perfect time gain undoes attenuation, and nothing else.

#include <gtest/gtest.h>

#include "support/plain_scene.h"
#include "support/surfaces.h"

namespace echocine {
namespace {

using namespace support;

Scene twoLayers(double alpha_1, double alpha_2) {
  Scene scene = plainScene(
      {medium("outside", 1050, 1540, alpha_1, 0.1), medium("inside", 1060, 1560, alpha_2, 0.3)});
  scene.probe.lines = 33;
  addStructure(scene, 1, 1);
  return scene;
}

PolarFrame traced(const Scene& scene) {
  const Surfaces surfaces({icosphere(3, 0.04).moved({0, 0, 0.07})});
  const EffectPlan plan = planEffects(scene);
  PolarFrame frame;
  traceFrame(surfaces.geometry(), scene.probe, TraceSettings(scene, plan),
             planeRequest(scene, plan), frame);
  return frame;
}

// Law: perfect TGC equals a run with every alpha 0. It undoes attenuation alone; the 1/l^2 stays.
TEST(PerfectGain, EqualsARunWithoutAnyAttenuationToTheLastBit) {
  const PolarFrame lossy = traced(twoLayers(10, 60)), free = traced(twoLayers(0, 0));
  EXPECT_EQ(lossy.intensities, free.intensities);
  EXPECT_NE(lossy.planes.at(Channel::y), free.planes.at(Channel::y));
}

// exp(-A) is 0 in floats long before A ends; a gain that undid it would be 0 times infinity.
TEST(PerfectGain, SurvivesAttenuationPastUnderflow) {
  const PolarFrame dead = traced(twoLayers(1e5, 1e5)), free = traced(twoLayers(0, 0));
  EXPECT_EQ(dead.intensities, free.intensities);
  EXPECT_EQ(dead.planes.at(Channel::y)[150], 0.0f);
}

// The paper's perfect gain undoes attenuation alone: 1/l^2 is another choice.
TEST(PerfectGain, KeepsTheSpreadWhenAskedTo) {
  Scene scene = twoLayers(10, 60);
  scene.signal.spread = Spread::keep;
  scene.output.channels = {Channel::y, Channel::unattenuated};
  const PolarFrame frame = traced(scene);
  EXPECT_EQ(frame.intensities.values, frame.planes.at(Channel::unattenuated));
}

TEST(NoGain, LeavesTheReceivedIntensity) {
  Scene scene = twoLayers(10, 60);
  scene.signal.spread = Spread::keep;
  scene.signal.tgc = Tgc::none;
  const PolarFrame frame = traced(scene);
  EXPECT_EQ(frame.intensities.values, frame.planes.at(Channel::y));
}

// Only effects run that can change an output.
TEST(Attenuation, IsNotComputedWhenNobodyCanSeeIt) {
  Scene scene = twoLayers(10, 60);
  scene.output.exr = false;
  const Surfaces surfaces({icosphere(3, 0.04).moved({0, 0, 0.07})});
  const EffectPlan plan = planEffects(scene);
  PolarFrame frame;
  const WorkCounts work = traceFrame(surfaces.geometry(), scene.probe, TraceSettings(scene, plan),
                                     planeRequest(scene, plan), frame);
  EXPECT_FALSE(plan.attenuation);
  EXPECT_EQ(work.samples_attenuated, 0u);
  EXPECT_GT(work.samples_backscatter, 0u);
}

}  // namespace
}  // namespace echocine
