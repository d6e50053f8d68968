// Meshes that others made, as they come and repaired.

#include <gtest/gtest.h>

#include "motion/mesh/mesh_check.h"
#include "motion/mesh/mesh_io.h"
#include "motion/repair/mesh_repair.h"
#include "tests/stage/motion_fixtures.h"
#include "tests/support/paths.h"

namespace echocine::motion_test {
namespace {

namespace fs = std::filesystem;

const fs::path kReal = fs::path(support::kSharedDir) / "real";

struct RealCase {
  const char* file;
  double mesh_unit_m;
  const char* refused;  // part of the refusal without repair; empty: accepted
  Repairs repair;
  const char* done;  // all that the repair says
  double volume;     // cubic mesh units, of the repaired mesh
};

constexpr Repairs kAll{.weld = true, .drop_degenerate = true, .orient = true, .fill_holes = true};

const RealCase kCases[] = {
    {"robustness/cardiomesh_LV4396_nonmanifold.obj", 1e-3,
     "remove it, or set repair = [\"drop-degenerate\"]", kAll,
     "28 duplicate faces dropped, 13 unused vertices dropped", 68220},
    {"robustness/slicerheart_marker_open_nonmanifold.obj", 1e-3,
     "remove it, or set repair = [\"drop-degenerate\"]", kAll,
     "1 vertex welded, 2 duplicate faces dropped, 1 vertex added where surfaces met in a point, "
     "1 unused vertex dropped, 23 holes filled (132 faces)",
     143892},
    {"robustness/slicerheart_AL_Papillary_Post.stl", 1e-3, "", kAll, "", 17120},
    // A closed left ventricle of 105.1 mL, an open right one inside out.
    {"statics/cardiomesh_biv.obj", 1e-3, "repair = [\"fill-holes\"]", kAll,
     "6705 faces turned, 2 holes filled (251 faces)", 236768},
    {"statics/ghdheart_4ch/3.obj", 0.1, "", kAll, "", 0.06499},
    {"statics/ghdheart_4ch/6.obj", 0.1, "", kAll, "", 0.04671},
    {"statics/ghdheart_4ch/7.obj", 0.1, "", kAll, "", 0.04408},
    {"statics/ghdheart_4ch/LA.obj", 0.1, "", kAll, "", 0.06591},
    {"statics/ghdheart_4ch/LV.obj", 0.1, "", kAll, "", 0.1146},
    {"statics/ghdheart_4ch/RA.obj", 0.1, "", kAll, "", 0.0756},
    {"statics/ghdheart_4ch/RV.obj", 0.1, "", kAll, "", 0.1189},
    {"statics/ghdheart_4ch/Standard_BiV.obj", 0.1, "", kAll, "", 0.208},
    {"statics/ghdheart_4ch/temp_4chambers.obj", 0.1, "", kAll, "", 0.375},
    {"statics/heartdeform_whole_heart/all.obj", 0.1, "", kAll, "", 0.05096},
    {"statics/heartdeform_whole_heart/region_1.obj", 0.1, "", kAll, "", 0.008439},
    {"statics/heartdeform_whole_heart/region_5.obj", 0.1, "", kAll, "", 0.006448},
};

KeyframeMesh readAs(const Structure& structure, const fs::path& file) {
  Sha256 digest;
  return readKeyframe({{file}, 0}, structure, digest);
}

class MotionRealMeshRepair : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kReal / "robustness")) GTEST_SKIP() << "needs " << kReal / "robustness";
  }
};

TEST_F(MotionRealMeshRepair, EachIsRefusedWithWhatToDoOrRepaired) {
  for (const RealCase& c : kCases) {
    SCOPED_TRACE(c.file);
    Structure structure = structureOf({});
    const auto mend = [&](std::vector<KeyframeMesh>& keyframes) {
      const std::string note = repairKeyframes(structure, keyframes);
      checkKeyframes(structure, keyframes, c.mesh_unit_m);
      return note;
    };
    std::vector<KeyframeMesh> keyframes{readAs(structure, kReal / c.file)};
    const std::string refusal = errorOf([&] { mend(keyframes); });
    EXPECT_NE(refusal.find(*c.refused ? c.refused : "no error"), std::string::npos) << refusal;
    structure.repair = c.repair;
    keyframes = {readAs(structure, kReal / c.file)};
    const std::size_t vertices = keyframes[0].mesh.positions.size();
    std::string note;
    EXPECT_EQ(errorOf([&] { note = mend(keyframes); }), "no error");
    EXPECT_EQ(
        note,
        *c.done ? "scene.toml:7: structure.keyframes: ball: repaired: " + std::string(c.done) : "");
    const TriangleMesh& mesh = keyframes[0].mesh;
    if (!*c.done) {
      EXPECT_EQ(mesh.positions.size(), vertices);
    }
    EXPECT_EQ(leakCount(mesh.triangles), 0u);
    EXPECT_NEAR(signedVolume(mesh), c.volume, 1e-3 * c.volume);
  }
}

TEST_F(MotionRealMeshRepair, ASoupOfThePapillaryMuscleIsWeldedToTheMeshItWas) {
  const TestFolder folder;
  const Structure plain = structureOf({});
  const TriangleMesh whole =
      readAs(plain, kReal / "robustness/slicerheart_AL_Papillary_Post.stl").mesh;
  TriangleMesh soup;
  for (const Triangle& t : whole.triangles) {
    const auto next = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : t) soup.positions.push_back(whole.positions[v]);
    soup.triangles.push_back({next, next + 1, next + 2});
  }
  const fs::path file = folder.write("soup.obj", objText(soup));
  std::vector<KeyframeMesh> keyframes{readAs(plain, file)};
  EXPECT_NE(errorOf([&] { checkKeyframes(plain, keyframes, 1e-3); }).find("repair = [\"weld\"]"),
            std::string::npos);
  Structure structure = plain;
  structure.repair.weld = true;
  const std::string note = repairKeyframes(structure, keyframes);
  EXPECT_NE(note.find("repaired: 137841 vertices welded"), std::string::npos) << note;
  EXPECT_EQ(keyframes[0].mesh.positions.size(), whole.positions.size());
  EXPECT_EQ(errorOf([&] { checkKeyframes(structure, keyframes, 1e-3); }), "no error");
  EXPECT_NEAR(signedVolume(keyframes[0].mesh), signedVolume(whole), 1e-9 * signedVolume(whole));
}

}  // namespace
}  // namespace echocine::motion_test
