// A live session without sockets: its pictures, its scene, and its refusals.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>

#include "core/parallel.h"
#include "live/live_session.h"
#include "scene/scene_reader.h"
#include "support/loop_scene.h"
#include "support/run_program.h"
#include "video/cine_writer.h"

namespace echocine::live {
namespace {

using namespace support;
using Json = nlohmann::ordered_json;

class Live : public ::testing::Test {
 protected:
  Live() {
    writeBallMeshes(folder);
    SceneText text = ballScene(6);
    text.output["png"] = "true";
    text.output["exr"] = "false";
    scene_file = folder.write("scene.toml", text.text());
    withThreads(2, [&] { session.emplace(scene_file, std::filesystem::path()); });
  }

  HttpResponse ask(const std::string& path, const std::string& body) {
    HttpRequest request{"POST", path, "", {}, body};
    auto reply = session->answer(request);
    if (auto* response = std::get_if<HttpResponse>(&reply)) return *response;
    HttpResponse response;
    withThreads(2, [&] { response = std::get<LiveJob>(reply).run(); });
    return response;
  }

  static Json headOf(const std::string& body) {
    std::size_t size = 0;
    for (int i = 3; i >= 0; --i) size = size << 8 | static_cast<unsigned char>(body[i]);
    return Json::parse(body.substr(4, size));
  }
  static std::string greysOf(const std::string& body) {
    const Json head = headOf(body);
    const std::size_t count = head["width"].get<std::size_t>() * head["height"].get<std::size_t>();
    return body.substr(body.size() - count);
  }

  TempFolder folder;
  std::filesystem::path scene_file;
  std::optional<LiveSession> session;
};

// A pose that is no round number, and other settings.
const std::string kKeys =
    R"({"probe.apex": [0.31, -0.17, 0.05], "probe.axis": [0.03, 0.02, 1], "probe.depth_mm": 110,
        "signal.gain_db": 2.5, "signal.look": "scanner"})";

TEST_F(Live, TheStillPictureIsTheFileThatRenderWrites) {
  const HttpResponse saved = ask("/save", R"({"name": "moved.toml", "keys": )" + kKeys + "}");
  ASSERT_EQ(saved.status, 200) << saved.body;
  const Outcome rendered = renderScene(folder / "moved.toml", folder / "loop");
  ASSERT_EQ(rendered.code, 0) << rendered.err;
  for (const int frame : {0, 4}) {
    const HttpResponse png =
        ask("/png", fmt::format(R"({{"frame": {}, "keys": {}}})", frame, kKeys));
    ASSERT_EQ(png.status, 200) << png.body;
    EXPECT_EQ(png.body, bytesOf(folder / fmt::format("loop/png/frame_{:04}.png", frame)));
    // What the page shows has the pixels of that file.
    const std::string greys =
        greysOf(ask("/picture", fmt::format(R"({{"frame": {}, "keys": {}}})", frame, kKeys)).body);
    GreyImage image{160, 120, {greys.begin(), greys.end()}};
    const std::vector<std::byte> again = encodePng(image);
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(again.data()), again.size()), png.body);
  }
}

// The ball has no speckle and fewer lines than a moving picture: only the rounding of the meshes'
// place to single precision remains.
TEST_F(Live, AMovingPictureIsTheStillOneWhereItLeavesNothingOut) {
  const std::string keys = R"({"probe.apex": [0.31, -0.17, 0.05], "probe.axis": [0.03, 0.02, 1],
                               "signal.reference_intensity": 1e-3})";
  for (const int frame : {0, 3}) {
    const std::string rest = fmt::format(R"("frame": {}, "keys": {}}})", frame, keys);
    const HttpResponse still = ask("/picture", R"({"effort": "still", )" + rest);
    const HttpResponse moving = ask("/picture", R"({"effort": "moving", )" + rest);
    ASSERT_EQ(moving.status, 200) << moving.body;
    EXPECT_EQ(headOf(moving.body)["effort"], "moving");
    const std::string a = greysOf(still.body), b = greysOf(moving.body);
    ASSERT_EQ(a.size(), b.size());
    double sum = 0, greys = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      sum += std::abs(static_cast<unsigned char>(a[i]) - static_cast<unsigned char>(b[i]));
      greys += static_cast<unsigned char>(a[i]);
    }
    EXPECT_GT(greys / static_cast<double>(a.size()), 1) << "an empty picture shows no difference";
    EXPECT_LT(sum / static_cast<double>(a.size()), 0.1);
  }
}

TEST_F(Live, TheSavedSceneDiffersInTheseKeysOnly) {
  const Json scene = Json::parse(ask("/scene", R"({"keys": )" + kKeys + "}").body);
  std::vector<std::string> keys;
  for (const Json& change : scene["changes"]) keys.push_back(change["key"]);
  EXPECT_EQ(keys, (std::vector<std::string>{"probe.apex", "probe.axis", "probe.depth_mm",
                                            "signal.gain_db", "signal.look"}));
  EXPECT_EQ(scene["values"]["signal.gain_db"], 2.5);
  EXPECT_EQ(scene["values"]["speckle.on"], true);  // of the look
  EXPECT_EQ(ask("/save", R"({"name": "a.toml"})").status, 200);
  EXPECT_EQ(bytesOf(folder / "a.toml"), bytesOf(scene_file));
  EXPECT_EQ(ask("/save", R"({"name": "a.toml"})").status, 409);
  EXPECT_EQ(ask("/save", R"({"name": "a.toml", "replace": true})").status, 200);
}

TEST_F(Live, RefusesWithAStatusAndOneLine) {
  const auto refused = [&](int status, const std::string& path, const std::string& body,
                           const std::string& words) {
    const HttpResponse response = ask(path, body);
    EXPECT_EQ(response.status, status) << body << response.body;
    EXPECT_NE(response.body.find(words), std::string::npos) << response.body;
    EXPECT_EQ(std::count(response.body.begin(), response.body.end(), '\n'), 1) << response.body;
  };
  refused(400, "/picture", "{", "not JSON");
  refused(400, "/picture", "[]", "not a JSON object");
  refused(400, "/picture", R"({"frames": 1})", "frames: is not a known field");
  refused(400, "/picture", R"({"frame": -1})", "frame: accepted");
  refused(404, "/etc/passwd", "{}", "not found");
  refused(422, "/picture", R"({"frame": 6})", "accepted: 0 to 5");
  refused(422, "/picture", R"({"keys": {"probe.depth_m": 1}})", "nearest: probe.depth_mm");
  refused(422, "/picture", R"({"keys": {"structure.keyframes": "/etc/passwd"}})", "changed live");
  refused(422, "/picture", R"({"keys": {"probe.lines": 0}})", "probe.lines");
  refused(422, "/picture", R"({"keys": {"probe.depth_mm": {"a": 1}}})", "probe.depth_mm");
  refused(422, "/picture", R"({"keys": {"signal.look": "a\nb = 1"}})", "signal.look");
  refused(422, "/save", R"({"name": "../scene.toml"})", "without folders");
  refused(422, "/view", R"({"view": "a9c"})", "not a standard view");
  EXPECT_EQ(ask("/picture", "{}").status, 200) << "the session goes on";
}

// Of waiting pictures the newest is made; a complete one that runs gives way.
TEST(LiveQueue, TheNewestPictureWins) {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::pair<int, int>> answers;  // job, status
  bool begun = false;
  {
    JobQueue queue(1);
    const auto answer = [&](int job) {
      return [&, job](HttpResponse response) {
        const std::lock_guard lock(mutex);
        answers.emplace_back(job, response.status);
        changed.notify_all();
      };
    };
    const auto endless = [&]() -> HttpResponse {
      {
        const std::lock_guard lock(mutex);
        begun = true;
        changed.notify_all();
      }
      for (;;) checkpoint();
    };
    queue.push({endless, true, true}, answer(0));
    {
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return begun; });
    }
    const auto quick = [] { return HttpResponse{}; };
    queue.push({quick, true, false}, answer(1));
    {
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return answers.size() == 2; });
    }
    EXPECT_EQ(answers, (std::vector<std::pair<int, int>>{{0, 204}, {1, 200}}));
    answers.clear();
    begun = false;
    queue.push({endless, false, false}, answer(2));
    {
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return begun; });
    }
    queue.push({quick, true, true}, answer(3));
    queue.push({quick, true, true}, answer(4));  // replaces 3
    {
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return answers.size() == 1; });
    }
    EXPECT_EQ(answers, (std::vector<std::pair<int, int>>{{3, 204}}));
  }  // the end of the queue stops what runs
  EXPECT_EQ(answers.back(), (std::pair<int, int>{2, 204}));
}

TEST(LiveCommand, RefusesATakenPortAndAnUnusableScene) {
  const TempFolder folder;
  const std::string scene = writeBall(folder, ballScene(4)).string();
  const std::string first = "'" + (folder / "first").string() + "'";
  EXPECT_EQ(runShell("%B live '" + (folder / "none.toml").string() + "'").code, 2);
  EXPECT_EQ(runShell("%B live '" + scene + "' --port 99999").code, 2);
  const Outcome taken = runShell("%B live '" + scene + "' --no-browser --quiet > " + first +
                                 " & one=$!; for i in $(seq 600); do [ -s " + first +
                                 " ] && break; sleep 0.1; done; "
                                 "port=$(sed 's/.*:\\([0-9]*\\)\\/.*/\\1/' " +
                                 first +
                                 "); "
                                 "%B live '" +
                                 scene +
                                 "' --port $port; code=$?; "
                                 "kill -INT $one; wait $one; echo ended $?; exit $code");
  EXPECT_EQ(taken.code, 1) << taken.err;
  EXPECT_NE(taken.err.find("Address already in use"), std::string::npos) << taken.err;
  EXPECT_EQ(std::count(taken.err.begin(), taken.err.end(), '\n'), 1) << taken.err;
  EXPECT_NE(taken.out.find("ended 0"), std::string::npos) << taken.out;
}

}  // namespace
}  // namespace echocine::live
