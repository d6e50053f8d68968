#pragma once
// echocine live SCENE.toml

#include "live/live.h"

namespace CLI {
class App;
}

namespace echocine {

class LiveCommand {
 public:
  explicit LiveCommand(CLI::App& app);  // adds the sub-command
  int run();                            // exit code

 private:
  live::LiveOptions options_;
  bool no_browser_ = false, quiet_ = false;
};

}  // namespace echocine
