// Bent lines: Snell at every interface of real surfaces, restarts without loss.

#include <gtest/gtest.h>

#include "scene/scan_geometry.h"
#include "support/plain_scene.h"
#include "support/surfaces.h"
#include "trace/interface_law.h"

namespace echocine {
namespace {

using namespace support;

// A wide slab between two depths, faster than its surroundings.
struct Slab {
  Scene scene =
      plainScene({medium("slow", 1000, 1450, 0, 0.1), medium("fast", 1000, 1600, 0, 0.2)});
  Surfaces surfaces{{box({-0.5, -0.5, 0.05}, {0.5, 0.5, 0.09})}};

  Slab() { addStructure(scene, 1, 1); }
  LineTrace line(double angle) const {
    TraceSettings settings(scene, planEffects(scene));
    settings.reflection_cap = settings.thin_layers = false;  // the paper's letter
    LineTrace trace;
    LineWalker walker(settings, {{0, 0, 0}, {std::sin(angle), 0, std::cos(angle)}}, {}, trace);
    std::vector<RayCrossings> met(1);
    while (walker.alive()) {
      surfaces.geometry().crossings(std::vector{walker.query()}, met);
      walker.advance(met[0]);
    }
    return trace;
  }
};

// A plane slab shifts a ray sideways and gives it its direction back.
TEST(RefractedLine, ASlabIsCrossedBySnellsLaw) {
  const Slab slab;
  for (const double angle : {0.0, 0.1, 0.3, 0.5, 0.7, 0.9}) {
    const LineTrace line = slab.line(angle);
    ASSERT_EQ(line.segments.size(), 3u) << angle;
    const double inside = std::asin(std::sin(angle) * 1600 / 1450);
    EXPECT_NEAR(line.segments[0].end_depth_m, 0.05 / std::cos(angle), 1e-8);
    EXPECT_NEAR(line.segments[1].end_depth_m,
                std::min(0.16, 0.05 / std::cos(angle) + 0.04 / std::cos(inside)), 1e-7);
  }
}

// R is the same from both sides along one ray.
TEST(RefractedLine, LosesTheSameOnTheWayInAndOut) {
  const Slab slab;
  const LineTrace line = slab.line(0.6);
  ASSERT_EQ(line.echoes.size(), 2u);
  const double R = interfaceLaw(1.45e6, 1450, 1.6e6, 1600, std::cos(0.6)).R;
  EXPECT_NEAR(line.echoes[0].intensity, R * std::pow(std::cos(0.6), 2), 1e-8);
  const double cos_inside = std::sqrt(1 - std::pow(std::sin(0.6) * 1600 / 1450, 2));
  EXPECT_NEAR(line.echoes[1].intensity, R * (1 - R) * (1 - R) * cos_inside * cos_inside, 1e-8);
}

TEST(RefractedLine, EndsAtTotalReflection) {
  const Slab slab;
  const LineTrace line = slab.line(std::asin(1450.0 / 1600) + 1e-4);
  EXPECT_EQ(line.segments.size(), 1u);
  EXPECT_EQ(line.echoes.size(), 1u);
  EXPECT_LT(line.segments.back().end_depth_m, slab.scene.probe.max_depth_m);
}

// Symmetric meshes put vertices and edges into the imaging plane: bent rays start on them.
TEST(RefractedLine, EveryLineThroughASymmetricBallPassesItExactlyOnce) {
  Scene scene =
      plainScene({medium("slow", 1000, 1500, 0, 0.1), medium("fast", 1000, 1560, 0, 0.2)});
  addStructure(scene, 1, 1);
  scene.probe.lines = 1001;
  scene.output.channels = {Channel::medium};
  const Surfaces surfaces({octasphere(5, 0.03).moved({0, 0, 0.07})});
  const EffectPlan plan = planEffects(scene);
  PolarFrame frame;
  traceFrame(surfaces.geometry(), scene.probe, TraceSettings(scene, plan),
             planeRequest(scene, plan), frame);
  for (int i = 0; i < 1001; ++i) {
    const double miss = 0.07 * std::abs(std::sin(lineGeometry(scene.probe, i).direction.x));
    int changes = 0;
    for (int k = 1; k < frame.samples; ++k) {
      const std::size_t at = static_cast<std::size_t>(i * frame.samples + k);
      changes += frame.medium[at] != frame.medium[at - 1];
    }
    if (miss < 0.026) {
      EXPECT_EQ(changes, 2) << "line " << i;
    }
    EXPECT_LE(changes, 2) << "line " << i;
  }
}

}  // namespace
}  // namespace echocine
