// Blocks of tissue that no beam reaches are left out before they are filled: the scatterers are
// those of a search by the whole scene's largest motion, to the last bit.

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>

#include "motion/heart/heart_scene.h"
#include "scene/looks.h"
#include "scene/scene_reader.h"
#include "speckle/field_material.h"
#include "speckle/scatterers.h"
#include "support/loop_scene.h"

namespace echocine {
namespace {

// The same tissue, of which nothing is known but how far any of it moves.
class FarReaching : public Material {
 public:
  explicit FarReaching(const Material& material) : of_(material) {}
  CubeLattice lattice() const override { return of_.lattice(); }
  bool blood(std::uint16_t group) const override { return of_.blood(group); }
  bool coarse(std::uint16_t group) const override { return of_.coarse(group); }
  void groupsAt(std::span<const Vec3f> at_m, std::span<std::uint16_t> groups) const override {
    asked += at_m.size();
    of_.groupsAt(at_m, groups);
  }
  void overTheBeat(const std::function<void(const MaterialFrame&)>& look) const override {
    of_.overTheBeat(look);
  }
  double reachAcross_m() const override { return of_.reachAcross_m(); }
  double reachAlong_m() const override { return of_.reachAlong_m(); }

  mutable std::atomic<std::size_t> asked{0};

 private:
  const Material& of_;
};

class NearReaching : public FarReaching {
 public:
  explicit NearReaching(const FieldMaterial& material) : FarReaching(material), of_(material) {}
  Box movesOver(Vec3f low_m) const override { return of_.movesOver(low_m); }

 private:
  const FieldMaterial& of_;
};

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
  ASSERT_GT(a.count(), 1000u);
  ASSERT_EQ(a.count(), b.count());
  ASSERT_EQ(a.batches().size(), b.batches().size());
  for (std::size_t i = 0; i < a.batches().size(); ++i) {
    const ScattererBatch &x = a.batches()[i], &y = b.batches()[i];
    ASSERT_TRUE(x.first == y.first && x.count == y.count && x.group == y.group &&
                x.pattern == y.pattern && x.low_m == y.low_m);
    const std::size_t eights = (x.count + kFloatLanes - 1) / kFloatLanes;
    ASSERT_EQ(std::memcmp(a.places(x), b.places(y), eights * sizeof(EightPlaces)), 0);
  }
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
