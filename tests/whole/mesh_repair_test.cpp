// Repaired meshes through the whole program.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "motion/mesh/mesh_io.h"
#include "support/exr_planes.h"
#include "support/paths.h"
#include "support/run_program.h"
#include "support/scene_text.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

class MeshRepair : public ::testing::Test {
 protected:
  // A ball in muscle under the probe.
  Outcome render(const std::string& mesh, const std::string& repair, const std::string& out) {
    SceneText text;
    text.probe["lines"] = "48";
    text.acquisition["frame_rate_hz"] = "1";
    text.addStructure("ball", "blood", "\"" + mesh + "\"", 1, repair);
    const fs::path scene = folder.write(out + ".toml", text.text());
    return runShell("%B render '" + scene.string() + "' -o '" + (folder / out).string() + "'");
  }
  nlohmann::json manifest(const std::string& out) const {
    return nlohmann::json::parse(bytesOf(folder / out / "manifest.json"));
  }
  ExrPlane plane(const std::string& out) const {
    return exrPlane(folder / out / "intensity/frame_0000.exr", "Y");
  }
  void expectSameImage(const std::string& one, const std::string& other) const {
    EXPECT_EQ(plane(one).bits, plane(other).bits);
    EXPECT_EQ(bytesOf(folder / one / "cine.avi"), bytesOf(folder / other / "cine.avi"));
  }
  const Mesh ball = icosphere(3, 2.5).moved({0.3, 0.2, 6});
  TempFolder folder;
};

TEST_F(MeshRepair, ATurnedBallGivesTheImageOfTheBallBitForBit) {
  writeObj(ball, folder / "ball.obj");
  writeObj(ball.insideOut(), folder / "turned.obj");
  EXPECT_EQ(render("ball.obj", "", "clean").code, 0);
  const Outcome refused = render("turned.obj", "", "refused");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("turned.obj encloses a volume of -"), std::string::npos);
  EXPECT_NE(refused.err.find("or set repair = [\"orient\"]"), std::string::npos) << refused.err;
  EXPECT_FALSE(fs::exists(folder / "refused"));
  const Outcome repaired = render("turned.obj", "repair = [\"orient\"]", "repaired");
  EXPECT_EQ(repaired.code, 0);
  expectSameImage("clean", "repaired");
  const std::string warning = "structure.keyframes: ball: repaired: 1280 faces turned";
  EXPECT_NE(repaired.err.find(warning), std::string::npos) << repaired.err;
  const nlohmann::json warnings = manifest("repaired").at("warnings");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].get<std::string>().ends_with(warning)) << warnings[0];
}

TEST_F(MeshRepair, OfACleanMeshChangesTheSceneButNotTheImage) {
  writeObj(ball, folder / "ball.obj");
  EXPECT_EQ(render("ball.obj", "", "clean").code, 0);
  const Outcome repaired = render(
      "ball.obj", "repair = [\"fill-holes\", \"weld\", \"orient\", \"drop-degenerate\"]", "all");
  EXPECT_EQ(repaired.code, 0);
  EXPECT_EQ(repaired.err.find("warning"), std::string::npos) << repaired.err;
  expectSameImage("clean", "all");
  const nlohmann::json json = manifest("all");
  EXPECT_EQ(json.at("scene").at("structures")[0].at("repair"),
            nlohmann::json({"weld", "drop-degenerate", "orient", "fill-holes"}));
  EXPECT_NE(json.at("scene_sha256"), manifest("clean").at("scene_sha256"));
}

// Weld and orientation do not depend on how a file orders what it holds; sums do, by rounding.
TEST_F(MeshRepair, AWeldedSoupGivesTheImageOfTheBall) {
  Mesh soup;
  for (const Triangle& t : ball.triangles) {
    const auto next = static_cast<std::uint32_t>(soup.points.size());
    for (const std::uint32_t v : t) soup.points.push_back(ball.points[v]);
    soup.triangles.push_back({next, next + 2, next + 1});
  }
  writeObj(ball, folder / "ball.obj");
  writeObj(soup, folder / "soup.obj");
  EXPECT_EQ(render("ball.obj", "", "clean").code, 0);
  EXPECT_EQ(render("soup.obj", "repair = [\"weld\", \"orient\"]", "repaired").code, 0);
  expectSameImage("clean", "repaired");
}

TEST_F(MeshRepair, ARealSoupRenders) {
  const fs::path stl =
      fs::path(support::kSharedDir) / "real/robustness/slicerheart_AL_Papillary_Post.stl";
  if (!fs::exists(stl)) GTEST_SKIP() << "needs " << stl;
  Sha256 digest;
  const TriangleMesh whole = readMesh(stl, digest);
  Vec3d middle;
  for (const Vec3d& p : whole.positions)
    middle = middle + 1.0 / static_cast<double>(whole.positions.size()) * p;
  Mesh soup;  // mm to the scene's cm, under the probe
  for (const Triangle& t : whole.triangles) {
    const auto next = static_cast<std::uint32_t>(soup.points.size());
    for (const std::uint32_t v : t)
      soup.points.push_back(0.1 * (whole.positions[v] - middle) + Vec3d{0, 0, 6});
    soup.triangles.push_back({next, next + 1, next + 2});
  }
  writeObj(soup, folder / "soup.obj");
  const Outcome refused = render("soup.obj", "", "refused");
  EXPECT_NE(refused.err.find("repair = [\"weld\"]"), std::string::npos) << refused.err;
  const Outcome outcome = render("soup.obj", "repair = [\"weld\"]", "welded");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("137841 vertices welded"), std::string::npos) << outcome.err;
  const nlohmann::json volumes = manifest("welded").at("frames")[0].at("volumes_ml");
  EXPECT_NEAR(volumes.at("ball").get<double>(), 17.12, 0.01);
  const ExrPlane image = plane("welded");
  EXPECT_GT(
      std::count_if(image.bits.begin(), image.bits.end(), [](auto bits) { return bits != 0; }), 0);
}

}  // namespace
}  // namespace echocine
