#pragma once
// echocine archive SCENE.toml -o OUTPUT --layout LAYOUT

#include <filesystem>
#include <string>

namespace CLI {
class App;
}

namespace echocine {

class ArchiveCommand {
 public:
  explicit ArchiveCommand(CLI::App& app);  // adds the sub-command
  int run();                               // exit code

 private:
  std::string scene_file_, layout_, exam_, recording_;
  std::filesystem::path output_;
  int threads_ = 0;
  bool quiet_ = false;
};

}  // namespace echocine
