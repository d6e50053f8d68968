#pragma once
// echocine dataset: a spec in, a folder of many loops with truth out.

#include <filesystem>
#include <string>

namespace CLI {
class App;
}

namespace echocine {

class DatasetCommand {
 public:
  explicit DatasetCommand(CLI::App& app);
  int run();

 private:
  std::filesystem::path spec_file_, folder_;
  std::string task_;
  int threads_ = 0;
  bool merge_ = false, quiet_ = false;
};

}  // namespace echocine
