#pragma once
// echocine study SCENE.toml -o DIR

#include <string>

#include "study/study.h"

namespace CLI {
class App;
}

namespace echocine {

// One thread by default: settings are compared by the time of a single frame.
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
