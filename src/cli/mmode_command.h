#pragma once
// echocine mmode SCENE.toml -o FOLDER

#include <optional>
#include <string>

#include "mmode/mmode_files.h"

namespace CLI {
class App;
}

namespace echocine {

class MModeCommand {
 public:
  explicit MModeCommand(CLI::App& app);  // adds the sub-command
  int run();                             // exit code

 private:
  std::string scene_file_, through_;
  std::optional<double> angle_deg_, offset_mm_;
  MModeOptions options_;
  bool quiet_ = false;
};

}  // namespace echocine
