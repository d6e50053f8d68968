#pragma once
// echocine plan SCENE.toml

#include <filesystem>
#include <string>

#include "cli/accuracy_options.h"

namespace CLI {
class App;
}

namespace echocine {

// Renders a few frames into a temporary folder to measure the expected cost of the loop.
class PlanCommand {
 public:
  explicit PlanCommand(CLI::App& app);  // adds the sub-command
  int run();                            // exit code

 private:
  std::string scene_file_;
  std::filesystem::path page_;
  int threads_ = 0;
  bool json_ = false, quiet_ = false, interpolation_ = false;
  AccuracyOptions accuracy_;
};

}  // namespace echocine
