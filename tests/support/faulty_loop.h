#pragma once
// A small loop with all kinds of output, rendered once undisturbed and then into faults.

#include "support/faulty_run.h"
#include "support/loop_output.h"
#include "support/loop_scene.h"

namespace echocine::support {

class FaultyLoop : public ::testing::Test {
 protected:
  using Files = std::map<std::string, std::string>;

  static SceneText sceneText(int frames = 3) {
    SceneText text = ballScene(frames);
    text.probe["lines"] = "16";
    text.output["png"] = "true";
    text.output["dicom"] = "true";
    makeCoarse(text);
    return text;
  }
  explicit FaultyLoop(const SceneText& text = sceneText()) {
    writeBall(folder, text);
    const Outcome whole = outcomeOf(rendering(undisturbed), &steps);
    EXPECT_EQ(whole.code, 0) << whole.err;
    files = leftIn(undisturbed);
  }
  FaultyRun rendering(const fs::path& where, const std::vector<std::string>& more = {},
                      int threads = 1) const {
    FaultyRun run{{"render", scene, "-o", where, "--quiet", "--threads", std::to_string(threads)}};
    run.arguments.insert(run.arguments.end(), more.begin(), more.end());
    return run;
  }
  // Whatever stands in `out`, going on completes it to the bytes of the undisturbed run.
  void expectResumes() const {
    const Outcome resumed = outcomeOf(rendering(out, {"--resume"}, 2));
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_EQ(resumed.err, "");
    expectSame(leftIn(out), files);
  }
  // A run into a new folder that meets `fault`.
  Outcome disturbed(const std::string& fault, int threads = 1) const {
    fs::remove_all(out);
    FaultyRun run = rendering(out, {}, threads);
    run.fault = fault;
    return outcomeOf(run);
  }

  TempFolder folder;
  const fs::path scene = folder / "scene.toml", out = folder / "out",
                 undisturbed = folder / "whole";
  Steps steps;
  Files files;
};

}  // namespace echocine::support
