#pragma once
// echocine doppler SCENE.toml -o FOLDER

#include <optional>
#include <string>

#include "doppler/doppler_files.h"

namespace CLI {
class App;
}

namespace echocine {

class DopplerCommand {
 public:
  explicit DopplerCommand(CLI::App& app);  // adds the sub-command
  int run();                               // exit code

 private:
  std::string scene_file_, through_, wall_ = "none";
  std::optional<double> angle_deg_, offset_mm_, depth_mm_, volume_mm_;
  double gate_mm_ = 1;
  DopplerOptions options_;
  bool quiet_ = false;
};

}  // namespace echocine
