#pragma once
// echocine compare SYNTHETIC REAL -o DIR

#include <string>

#include "compare/compare.h"

namespace CLI {
class App;
}

namespace echocine {

// Options as given; compareLoops() judges what files can tell.
class CompareCommand {
 public:
  explicit CompareCommand(CLI::App& app);  // adds the sub-command
  int run();                               // exit code

 private:
  compare::CompareOptions options_;
  std::filesystem::path folder_;
  int threads_ = 0;
  bool quiet_ = false, no_space_ = false;
};

}  // namespace echocine
