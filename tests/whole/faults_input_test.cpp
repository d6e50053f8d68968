// Input that changes between runs or under a run, and two runs that want the same folder.

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/file.h>

#include "support/faulty_loop.h"

namespace echocine {
namespace {

using namespace support;

class ChangedInput : public FaultyLoop {
 protected:
  // Whatever was changed, going on refuses and leaves all as it was.
  void expectRefused() const {
    for (const char* state : {"whole", "one frame"}) {
      SCOPED_TRACE(state);
      fs::remove_all(out);
      fs::copy(undisturbed, out, fs::copy_options::recursive);
      if (std::string(state) == "one frame") {  // as a kill may leave it
        for (const char* gone : {"intensity/frame_0000.exr", "intensity/frame_0001.exr", "cine.avi",
                                 "manifest.json", "png/frame_0002.png"})
          fs::remove(out / gone);
      }
      const Files before = leftIn(out);
      const Outcome outcome = outcomeOf(rendering(out, {"--resume"}));
      expectOneLine(outcome, 2);
      EXPECT_NE(outcome.err.find("another scene"), std::string::npos) << outcome.err;
      expectSame(leftIn(out), before);
    }
  }
  void change(const SceneText& text) const { folder.write("scene.toml", text.text()); }
};

TEST_F(ChangedInput, OneVertexOfOneMesh) {
  std::string mesh = bytesOf(folder / "cavity_5.obj");
  mesh[mesh.find('.') + 6] ^= 1;
  folder.write("cavity_5.obj", mesh);
  expectRefused();
}

TEST_F(ChangedInput, ACommentInAMesh) {
  folder.write("wall_0.obj", "# another file\n" + bytesOf(folder / "wall_0.obj"));
  expectRefused();
}

TEST_F(ChangedInput, AKeyOfTheScene) {
  SceneText text = sceneText();
  text.acquisition["heart_rate_bpm"] = "61";
  change(text);
  expectRefused();
}

TEST_F(ChangedInput, AMediumOfTheScenesOwn) {
  SceneText text = sceneText();
  text.media =
      "[media.myocardium]\ndensity_kg_m3 = 1061\nsound_speed_m_s = 1580\n"
      "attenuation_db_cm_mhz = 0.52\nbackscatter = { kind = \"none\" }\n";
  change(text);
  expectRefused();
}

TEST_F(ChangedInput, AKeyframeMore) {
  fs::copy_file(folder / "wall_0.obj", folder / "wall_8.obj");
  fs::copy_file(folder / "cavity_0.obj", folder / "cavity_8.obj");
  expectRefused();
}

// A comment is not what is rendered: the same loop.
TEST_F(ChangedInput, ACommentInTheSceneIsTheSameLoop) {
  folder.write("scene.toml", "# a note\n" + sceneText().text());
  fs::copy(undisturbed, out, fs::copy_options::recursive);
  fs::remove(out / "intensity/frame_0001.exr");
  expectResumes();
}

// Meshes and scene are read once, before the first frame: what becomes of them later is of no
// effect.
TEST_F(ChangedInput, UnderARunIsOfNoEffect) {
  FaultyRun run = rendering(out);
  run.meanwhile = [this](pid_t child) {
    while (!fs::exists(out / "intensity/frame_0000.exr") && ::kill(child, 0) == 0) ::usleep(200);
    for (int i = 0; i < 8; ++i) {
      fs::remove(folder / ("wall_" + std::to_string(i) + ".obj"));
      folder.write("cavity_" + std::to_string(i) + ".obj", "no mesh any more");
    }
    fs::remove(scene);
  };
  const Outcome outcome = outcomeOf(run);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  expectSame(leftIn(out), files);
}

class TwoRuns : public FaultyLoop {
 protected:
  // A lock as another run holds it.
  class Held {
   public:
    explicit Held(const fs::path& folder) : file_(::open(folder.c_str(), O_RDONLY | O_CLOEXEC)) {
      EXPECT_EQ(::flock(file_, LOCK_EX | LOCK_NB), 0);
    }
    ~Held() { ::close(file_); }

   private:
    int file_;
  };
};

TEST_F(TwoRuns, IntoOneFolderTheSecondIsRefusedAndChangesNothing) {
  fs::copy(undisturbed, out, fs::copy_options::recursive);
  {
    const Held first(out);
    for (const auto& more : {std::vector<std::string>{}, {"--resume"}}) {
      const Outcome outcome = outcomeOf(rendering(out, more));
      expectOneLine(outcome, 1);
      EXPECT_NE(outcome.err.find("another run is writing there"), std::string::npos) << outcome.err;
      expectSame(leftIn(out), files);
    }
  }
  expectResumes();  // the lock is gone with the run that held it
}

// Six real ones at once: whoever wins, the folder holds one whole loop.
TEST_F(TwoRuns, StartedTogetherLeaveOneWholeLoop) {
  std::vector<Outcome> others;
  std::function<Outcome(int)> race = [&](int more) {
    FaultyRun one = rendering(out);
    if (more > 0) one.meanwhile = [&, more](pid_t) { others.push_back(race(more - 1)); };
    return outcomeOf(one);
  };
  others.push_back(race(5));
  int whole = 0;
  for (const Outcome& outcome : others) {
    if (outcome.code != 0) expectOneLine(outcome, 1);
    whole += outcome.code == 0;
  }
  EXPECT_GE(whole, 1);
  expectSame(leftIn(out), files);
}

TEST_F(TwoRuns, OfAHeartTheSecondIsRefused) {
  const fs::path part = folder / "heart.echocine-part";
  fs::create_directory(part);
  const Held first(part);
  const FaultyRun run{{"heart", "-o", folder / "heart", "--quiet", "--keyframes", "4"}};
  const Outcome outcome = outcomeOf(run);
  expectOneLine(outcome, 1);
  EXPECT_NE(outcome.err.find("another run is writing there"), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::exists(part));
  EXPECT_FALSE(fs::exists(folder / "heart"));
}

// Standard streams that are closed, full or gone do not end a job and get into no file.
class StandardStreams : public FaultyLoop {};

TEST_F(StandardStreams, AJobNeedsNone) {
  const std::string command = "%B render '" + scene.string() + "' -o '" + out.string() + "'";
  for (const std::string streams : {" >&- 2>&- <&-", " 2>/dev/full", " 2>&1 | true"}) {
    SCOPED_TRACE(streams);
    fs::remove_all(out);
    const Outcome outcome = runShell(command + streams);
    EXPECT_TRUE(outcome.code == 0) << outcome.code << outcome.err;
    expectSame(leftIn(out), files);
  }
  const Outcome refused = runShell("%B render nothing.toml -o '" + out.string() + "' 2>/dev/full");
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(runShell("%B plan '" + scene.string() + "' >/dev/full").code, 1);
}

}  // namespace
}  // namespace echocine
