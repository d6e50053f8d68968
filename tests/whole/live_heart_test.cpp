// Dials of a parametric heart in a live session: the new heart is the one that `heart` writes.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/parallel.h"
#include "live/heart_dials.h"
#include "live/live_session.h"
#include "live/mesh_paths.h"
#include "output/heart_files.h"
#include "scene/scene_reader.h"
#include "support/run_program.h"
#include "support/temp_folder.h"

namespace echocine::live {
namespace {

using namespace support;
using Json = nlohmann::ordered_json;

std::string textOf(const std::filesystem::path& file) {
  return bytesOf(file);
}

// Few keyframes, lines and samples.
class LiveHeartDials : public ::testing::Test {
 protected:
  struct Shared {
    Shared();
    TempFolder folder;
    std::filesystem::path scene_file;
    std::optional<LiveSession> session;
  };
  static void SetUpTestSuite() { shared = std::make_unique<Shared>(); }
  static void TearDownTestSuite() { shared.reset(); }

  static HttpResponse ask(const std::string& path, const std::string& body) {
    auto reply = shared->session->answer({"POST", path, "", {}, body});
    if (auto* response = std::get_if<HttpResponse>(&reply)) return *response;
    HttpResponse response;
    withThreads(2, [&] { response = std::get<LiveJob>(reply).run(); });
    return response;
  }

  static inline std::unique_ptr<Shared> shared;
  const TempFolder& folder = shared->folder;
};

LiveHeartDials::Shared::Shared() {
  HeartFiles files;
  files.keyframes = 4;
  files.look = Look::paper;
  writeHeart(files, folder / "heart");
  std::string text = textOf(folder / "heart/scene.toml");
  for (const auto& [from, to] :
       {std::pair{"lines = 256", "lines = 24"}, std::pair{"samples = 1024", "samples = 128"},
        std::pair{"frame_rate_hz = 50", "frame_rate_hz = 5"}})
    text.replace(text.find(from), std::string(from).size(), to);
  scene_file = folder.write("heart/scene.toml", text + "\n[output]\npng = true\nexr = false\n");
  withThreads(2, [&] { session.emplace(scene_file, folder / "poses"); });
}

TEST_F(LiveHeartDials, AnotherHeartHasItsVolumesAndIsSavedWithItsMeshes) {
  const std::string dials = R"("dials": {"ef": 0.35, "edv": 150}, "segments": {"7": 0.2})";
  EXPECT_EQ(ask("/picture", "{" + dials + "}").status, 410) << "not made yet";
  const HttpResponse made = ask("/heart", "{" + dials + "}");
  ASSERT_EQ(made.status, 200) << made.body;
  const Json answer = Json::parse(made.body);
  EXPECT_NE(answer["standard"], answer["own_standard"]) << "a larger heart, another apex";
  // The excursion of the ring follows the ejection fraction.
  for (const Json& dial : answer["heart"]["dials"]) {
    if (dial["key"] == "mapse") {
      EXPECT_NEAR(dial["value"].get<double>(), 13 * 0.35 / 0.6, 1e-9);
    }
  }

  const HttpResponse picture = ask("/picture", "{" + dials + R"(, "effort": "still", "frame": 0})");
  ASSERT_EQ(picture.status, 200) << picture.body;
  const std::size_t at = picture.body.find("\"lv_cavity\":");
  ASSERT_NE(at, std::string::npos);
  EXPECT_NEAR(std::stod(picture.body.substr(at + 12)), 150, 1.5);

  const HttpResponse saved = ask("/save", R"({"name": "failing.toml", )" + dials + "}");
  ASSERT_EQ(saved.status, 200) << saved.body;
  const HttpResponse png = ask("/png", "{" + dials + R"(, "frame": 2})");
  const std::string command = Json::parse(saved.body)["command"];
  EXPECT_EQ(command.find("echocine render '"), 0u) << command;
  const Outcome run = runShell("%B" + command.substr(8) + " --quiet --frames 2:3");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(png.body, bytesOf(folder / "heart/failing_loop/png/frame_0002.png"));
  // The recorded pose renders the same, though it is in another folder.
  ASSERT_EQ(runShell("%B render '" + (folder / "poses/pose_00000.toml").string() + "' -o '" +
                     (folder / "again").string() + "' --quiet --frames 2:3")
                .code,
            0);
  EXPECT_EQ(png.body, bytesOf(folder / "again/png/frame_0002.png"));

  // Back to the scene's own heart.
  const Json own = Json::parse(ask("/heart", "{}").body);
  EXPECT_EQ(own["standard"], own["own_standard"]);
}

// The loop has a beat of the new rate, and keyframes as `heart` spaces them at this rate.
TEST_F(LiveHeartDials, ARateChangesTheBeatItsEcgAndItsTiming) {
  const std::string dials = R"("dials": {"hr": 120, "ef": 0.5})";
  ASSERT_EQ(ask("/heart", "{" + dials + "}").status, 200);
  const Json own = Json::parse(ask("/scene", "{}").body);
  const Json fast = Json::parse(ask("/scene", "{" + dials + "}").body);
  EXPECT_EQ(own["loop"]["frames"], 5) << "at 65 beats a minute and 5 frames per second";
  EXPECT_EQ(fast["loop"]["frames"], 3) << "2.5, rounded";
  EXPECT_NE(own["loop"]["ecg"], fast["loop"]["ecg"]);
  HeartFiles files;
  files.keyframes = 4;
  files.look = Look::paper;
  files.parameters.heart_rate_bpm = 120;
  files.parameters.ejection_fraction = 0.5;
  writeHeart(files, folder / "fast");
  const Scene written = readScene(folder / "fast/scene.toml"),
              live = parseScene(fast["text"].get<std::string>(), folder / "fast/scene.toml");
  EXPECT_EQ(live.acquisition.heart_rate_hz, written.acquisition.heart_rate_hz);
  EXPECT_EQ(live.motion.keyframe_heart_rate_hz, written.motion.keyframe_heart_rate_hz);
  EXPECT_EQ(live.motion.keyframe_phases, written.motion.keyframe_phases);
  EXPECT_EQ(live.motion.end_systole_phase, written.motion.end_systole_phase);

  // A key of the scene plays the same keyframes at another rate. A page counts frames on over a
  // change of the loop.
  const Json slow = Json::parse(
      ask("/scene", "{" + dials + R"(, "keys": {"acquisition.heart_rate_bpm": 60}})").body);
  EXPECT_EQ(slow["loop"]["frames"], 5);
  const std::string late = "{" + dials + R"(, "frame": 4, "effort": "moving")";
  EXPECT_EQ(ask("/picture", late + "}").status, 422);
  const HttpResponse wrapped = ask("/picture", late + R"(, "wrap": true})");
  ASSERT_EQ(wrapped.status, 200);
  EXPECT_NE(wrapped.body.find(R"("frame":1,)"), std::string::npos);
}

TEST_F(LiveHeartDials, RefusesWhatNoHeartIs) {
  const auto refused = [&](const std::string& body, int status, const std::string& words) {
    const HttpResponse response = ask("/heart", body);
    EXPECT_EQ(response.status, status) << response.body;
    EXPECT_NE(response.body.find(words), std::string::npos) << response.body;
  };
  refused(R"({"dials": {"ef": 0.99}})", 422, "accepted are 0.05 to 0.85");
  refused(R"({"dials": {"hr": 20}})", 422, "accepted are 30 to 200 bpm");
  refused(R"({"dials": {"body-scale": 1}})", 422, "body-scale is not a dial");
  refused(R"({"dials": {"edv": 400, "ef": 0.8, "rv-edv": 100}})", 422, "raise rv-edv");
  refused(R"({"dials": {"size": 1}})", 422, "size is not a dial");
  refused(R"({"dials": {"ef": "a"}})", 400, "accepted: an object of numbers");
  refused(R"({"segments": {"18": 1}})", 422, "accepted: 1 to 17");
  refused(R"({"segments": {"x": 1}})", 400, "segments: accepted");
  EXPECT_EQ(ask("/picture", "{}").status, 200) << "the one before beats on";
}

// Truth over the picture: its volume is that of the picture, and Simpson's rule is near it.
TEST_F(LiveHeartDials, TruthHasLabelsOfThePixelsAndTheFunctionOfTheWall) {
  const HttpResponse response = ask(
      "/truth", R"({"frame": 2, "layers": ["labels", "wall"], "keys": {"probe.tilt_deg": null}})");
  EXPECT_EQ(response.status, 422) << "no key of a live scene";
  const HttpResponse truth = ask("/truth", R"({"frame": 2, "layers": ["labels", "wall"]})");
  ASSERT_EQ(truth.status, 200) << truth.body;
  std::size_t size = 0;
  for (int i = 3; i >= 0; --i) size = size << 8 | static_cast<unsigned char>(truth.body[i]);
  const Json head = Json::parse(truth.body.substr(4, size));
  EXPECT_EQ(truth.body.size(),
            4 + size + 2 * head["width"].get<std::size_t>() * head["height"].get<std::size_t>());
  EXPECT_FALSE(head["contours"].empty());
  ASSERT_TRUE(head.contains("function")) << head.value("no_wall", "");
  const Json& f = head["function"];
  EXPECT_NEAR(f["biplane_ml"].get<double>(), f["volume_ml"].get<double>(),
              0.15 * f["volume_ml"].get<double>());
  EXPECT_EQ(f["segments"].size(), 17u);
  EXPECT_LT(f["gls"].get<double>(), -3) << "in systole";
  EXPECT_GT(head["tracks"].size(), 50u);
  EXPECT_EQ(head["view"]["label"], "a4c");
}

TEST_F(LiveHeartDials, ALoopIsOneFileOfItsFormat) {
  EXPECT_EQ(ask("/loop", R"({"format": "gif"})").body.substr(0, 6), "GIF89a");
  EXPECT_EQ(ask("/loop", R"({"format": "mp4"})").body.substr(4, 4), "ftyp");
  const std::string webp = ask("/loop", R"({"format": "webp"})").body;
  EXPECT_EQ(webp.substr(0, 4) + webp.substr(8, 4), "RIFFWEBP");
  EXPECT_NE(webp.find("ANIM"), std::string::npos);
  EXPECT_EQ(ask("/loop", R"({"format": "avi"})").status, 400);
  const Json cost = Json::parse(ask("/cost", "{}").body);
  EXPECT_GT(cost["ms"].get<double>(), 0);
}

TEST(LiveNumpyHeart, HasTheDialsOfTheObjFiles) {
  const TempFolder folder;
  HeartFiles files;
  files.keyframes = 4;
  HeartChange change;
  change.dials["ef"] = 0.35;
  std::vector<std::string> texts;
  for (const auto& [name, format] :
       {std::pair{"obj", heart::MeshFormat::obj}, std::pair{"npz", heart::MeshFormat::npz}}) {
    files.format = format;
    writeHeart(files, folder / name);
    const std::filesystem::path file = folder / name / "scene.toml";
    const auto dials = HeartDials::of(readScene(file), textOf(file));
    ASSERT_TRUE(dials) << name;
    const OtherHeart other = dials->made(change, textOf(file));
    texts.push_back(other.text);
    EXPECT_EQ(parseScene(other.text, "heart", other.meshes).structures[0].keyframes.size(), 4u);
  }
  EXPECT_EQ(texts[0], texts[1]);
}

TEST(LiveMeshPaths, StayTheSameFilesInAnotherFolder) {
  const std::string text =
      "a = \"m/x_??.obj\"  # \"no.obj\"\nb = ['/abs.stl', 'y.PLY']\nc = \"word\"\n";
  EXPECT_EQ(
      withMeshesFrom(text, "/s/one", "/s/two"),
      "a = \"../one/m/x_??.obj\"  # \"no.obj\"\nb = ['/abs.stl', '../one/y.PLY']\nc = \"word\"\n");
  EXPECT_EQ(withMeshesFrom(text, "/s/one", "/s/one"), text);
  EXPECT_EQ(withMeshesFrom("a = ['m/x.npz', \"x.npz[3]\", '/x.npz']\n", "/s/one", "/s/two"),
            "a = ['../one/m/x.npz', \"../one/x.npz[3]\", '/x.npz']\n");
}

}  // namespace
}  // namespace echocine::live
