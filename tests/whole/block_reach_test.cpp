// Tissue that no beam reaches is left out before its scatterers are drawn. The rest is the same, to
// the last bit, as when all within the largest motion is drawn and then tested.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <numeric>

#include "motion/heart/heart_scene.h"
#include "scene/looks.h"
#include "scene/scene_reader.h"
#include "speckle/field_material.h"
#include "speckle/scatterers.h"
#include "support/loop_scene.h"

namespace echocine {
namespace {

// The same tissue, of which nothing is known but how far any of it moves: all of it is drawn.
class FarReaching : public Material {
 public:
  explicit FarReaching(const FieldMaterial& material) : of_(material) {}
  CubeLattice lattice() const override { return of_.lattice(); }
  bool blood(std::uint16_t group) const override { return of_.blood(group); }
  bool coarse(std::uint16_t group) const override { return of_.coarse(group); }
  std::vector<std::uint16_t> groupsIn(Vec3f) const override {
    std::vector<std::uint16_t> all(of_.field().groupCount());
    std::iota(all.begin(), all.end(), std::uint16_t{0});
    return all;
  }
  void groupsAt(std::span<const Vec3f> at_m, std::span<std::uint16_t> groups) const override {
    asked += at_m.size();
    of_.groupsAt(at_m, groups);
  }
  double reachAcross_m() const override { return of_.reachAcross_m(); }
  double reachAlong_m() const override { return of_.reachAlong_m(); }

  mutable std::atomic<std::size_t> asked{0};

 protected:
  const FieldMaterial& of_;
};

class NearReaching : public FarReaching {
 public:
  using FarReaching::FarReaching;
  std::vector<std::uint16_t> groupsIn(Vec3f low_m) const override { return of_.groupsIn(low_m); }
  void overTheBeat(const std::function<void(const MaterialFrame&)>& look) const override {
    of_.overTheBeat(look);
  }
  Box movesOver(Vec3f low_m, std::uint16_t group) const override {
    return of_.movesOver(low_m, group);
  }
};

// The cubes that a beam reaches at some instant, of all that were drawn.
std::vector<ScattererBatch> seenOf(const Scatterers& all, const BeamView& view,
                                   const FieldMaterial& material) {
  std::vector<bool> seen(all.batches().size());
  material.overTheBeat([&](const MaterialFrame& tissue) {
    for (std::size_t b = 0; b < seen.size(); ++b) {
      const ScattererBatch& batch = all.batches()[b];
      if (!seen[b])
        seen[b] = view.sees(extentOf(tissue.corners(batch.group, batch.low_m, batch.edge_m), 2e-3));
    }
  });
  std::vector<ScattererBatch> kept;
  for (std::size_t b = 0; b < seen.size(); ++b)
    if (seen[b]) kept.push_back(all.batches()[b]);
  return kept;
}

void expectSameScatterers(const Scene& scene, double most_asked) {
  const MeshMotion motion(scene);
  const FieldMaterial material(scene, motion);
  const FarReaching far(material);
  const NearReaching near(material);
  const PointSpread spread(scene.probe, scene.signal.pulse_cycles);
  const BeamView view(scene.probe, spread);
  const Scatterers a(scene.probe, spread, view, scene.speckle, far),
      b(scene.probe, spread, view, scene.speckle, near);
  EXPECT_LT(static_cast<double>(near.asked), most_asked * static_cast<double>(far.asked));
  const std::vector<ScattererBatch> expected = seenOf(a, view, material);
  ASSERT_GT(b.count(), 1000u);
  ASSERT_EQ(expected.size(), b.batches().size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const ScattererBatch &x = expected[i], &y = b.batches()[i];
    ASSERT_TRUE(x.count == y.count && x.group == y.group && x.pattern == y.pattern &&
                x.low_m == y.low_m);
    const std::size_t eights = (x.count + kFloatLanes - 1) / kFloatLanes;
    ASSERT_EQ(std::memcmp(a.places(x), b.places(y), eights * sizeof(EightPlaces)), 0);
    count += x.count;
  }
  EXPECT_EQ(count, b.count());
}

// The same tissue with a strength, which counts the scatterers that are weighed.
class Weighed : public NearReaching {
 public:
  using NearReaching::NearReaching;
  bool differs() const override { return true; }
  void amplitudes(std::span<const Vec3f> at_m, std::uint16_t group,
                  std::span<float> out) const override {
    weighed += at_m.size();
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = strengthAt(at_m[i], group);
  }
  static float strengthAt(Vec3f at_m, std::uint16_t group) {
    return 2 + static_cast<float>(group) + at_m.x + at_m.y + at_m.z;
  }
  mutable std::atomic<std::size_t> weighed{0};
};

// At instants between those that the search looks at, every scatterer whose place a beam may show
// has its strength. Places are found one by one here.
TEST(BlockReach, WeighsAllThatABeamShows) {
  Scene scene = heart::heartScene(heart::parametersFrom({}), heart::View::a4c, 6);
  scene.speckle.per_cell = 0.7;
  const MeshMotion motion(scene);
  const FieldMaterial material(scene, motion);
  const Weighed weighed(material);
  const PointSpread spread(scene.probe, scene.signal.pulse_cycles);
  const BeamView view(scene.probe, spread);
  const Scatterers all(scene.probe, spread, view, scene.speckle, weighed);
  EXPECT_LT(static_cast<double>(weighed.weighed), 0.8 * static_cast<double>(all.count()));
  std::size_t shown = 0;
  for (const double phase : {0.0, 0.0151, 0.17, 0.359, 0.61, 0.983}) {
    FieldFrame frame;
    material.field().at(phase, frame);
    const FieldMaterialFrame tissue(frame);
    for (const ScattererBatch& b : all.batches()) {
      const BeamCube cube = view.cubeOf(tissue.corners(b.group, b.low_m, b.edge_m));
      for (std::uint32_t i = 0; i < b.count; ++i) {
        const EightPlaces& eight = all.places(b)[i / kFloatLanes];
        const std::size_t lane = i % kFloatLanes;
        const Vec3f in = 1.0f / kCubeEdge *
                         Vec3f{static_cast<float>(eight.u[lane]), static_cast<float>(eight.v[lane]),
                               static_cast<float>(eight.w[lane])};
        float across = 0;
        for (std::size_t c = 0; c < kFloatLanes; ++c)
          across += (c & 1 ? in.x : 1 - in.x) * (c & 2 ? in.y : 1 - in.y) *
                    (c & 4 ? in.z : 1 - in.z) * cube.across[c];
        if (std::abs(across) > 1) continue;
        ++shown;
        ASSERT_EQ(all.strength(b)[i], Weighed::strengthAt(b.low_m + b.edge_m * in, b.group));
      }
    }
  }
  EXPECT_GT(shown, 1000u);
}

TEST(BlockReach, ChangesNoScattererOfAHeart) {
  for (const heart::View view : {heart::View::a4c, heart::View::psax_mid, heart::View::subcostal}) {
    Scene scene = heart::heartScene(heart::parametersFrom({}), view, 6);
    scene.speckle.per_cell = 0.7;
    expectSameScatterers(scene, 0.6);
  }
}

TEST(BlockReach, ChangesNoScattererOfABallThatBeats) {
  const support::TempFolder folder;
  support::SceneText text = support::ballScene(10);
  text.output["exr"] = "false";
  expectSameScatterers(readScene(support::writeBall(folder, text)), 1.01);
}

}  // namespace
}  // namespace echocine
