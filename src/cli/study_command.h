#pragma once
// echocine study SCENE.toml -o DIR

#include <string>

#include "study/study.h"

namespace CLI {
class App;
}

namespace echocine {

// One thread unless asked: times of a single frame are what settings are compared by.
class StudyCommand {
 public:
  explicit StudyCommand(CLI::App& app);  // adds the sub-command
  int run();                             // exit code

 private:
  std::string scene_file_;
  bool quiet_ = false;
  StudyOptions options_;
};

}  // namespace echocine
