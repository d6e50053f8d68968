#pragma once
// echocine compare SYNTHETIC REAL -o DIR, echocine compare REAL --scan DIALS -o DIR, or
// echocine compare REAL --views all -o DIR

#include <string>

#include "compare/compare.h"
#include "fit/dial_scan.h"
#include "fit/view_ranking.h"

namespace CLI {
class App;
}

namespace echocine {

// Options as given; compareLoops() checks what depends on files.
class CompareCommand {
 public:
  explicit CompareCommand(CLI::App& app);  // adds the sub-command
  int run();                               // exit code

 private:
  int runScan();
  int runViews();
  // Computes the result with a progress line, writes it into the folder and prints its table.
  template <typename Make, typename Write>
  int runAndTell(const char* last, const Make& make, const Write& write) const;
  // For a command that compares its own hearts with one loop.
  void needOneLoop(const char* option) const;

  CLI::App* command_;
  compare::CompareOptions options_;
  fit::ScanOptions scan_;
  std::string scan_text_, views_text_, dials_text_, view_text_ = "a4c";
  std::filesystem::path folder_;
  int threads_ = 0;
  bool quiet_ = false, no_space_ = false, no_ecg_ = false;
};

}  // namespace echocine
