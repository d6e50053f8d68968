#pragma once
// echocine view SCENE.toml -o page.html

#include <filesystem>
#include <string>

#include "view/scene_view.h"

namespace CLI {
class App;
}

namespace echocine {

class ViewCommand {
 public:
  explicit ViewCommand(CLI::App& app);  // adds the sub-command
  int run();                            // exit code

 private:
  std::string scene_file_;
  std::filesystem::path page_;
  ViewBudget budget_;
  int threads_ = 0;
  bool quiet_ = false;
};

}  // namespace echocine
