#pragma once
// echocine export LOOP ... -o FILE

#include <string>
#include <vector>

#include "export/export_loops.h"

namespace CLI {
class App;
}

namespace echocine {

class ExportCommand {
 public:
  explicit ExportCommand(CLI::App& app);  // adds the sub-command
  int run();                              // exit code

 private:
  ExportOptions options_;
  std::string tint_ = "none";
  bool quiet_ = false;
};

}  // namespace echocine
