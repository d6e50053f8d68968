#pragma once
// echocine heart -o DIR

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "output/heart_files.h"

namespace CLI {
class App;
}

namespace echocine {

class HeartCommand {
 public:
  explicit HeartCommand(CLI::App& app);  // adds the sub-command
  int run();                             // exit code

 private:
  HeartFiles wanted_;
  std::filesystem::path folder_;
  // By the dial's key; other dials follow.
  std::map<std::string, double> given_;
  std::string view_ = "a4c", rule_ = "segments", look_ = "scanner", format_ = "obj";
  std::vector<std::string> segments_;
  bool even_ = false, quiet_ = false;
};

}  // namespace echocine
