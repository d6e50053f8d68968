#pragma once
// echocine render SCENE.toml -o DIR

#include <string>

#include "cli/accuracy_options.h"
#include "render/render.h"

namespace CLI {
class App;
}

namespace echocine {

// The main job. Options of a run, which are not part of the scene, are here.
class RenderCommand {
 public:
  explicit RenderCommand(CLI::App& app);  // adds the sub-command
  int run();                              // exit code

 private:
  int renderAndTell();

  std::string scene_file_;
  std::string truth_;  // kinds, comma-separated
  std::string frames_;
  bool dicom_ = false, quiet_ = false;
  RenderOptions options_;
  AccuracyOptions accuracy_;
};

}  // namespace echocine
