#pragma once
// echocine fit --view a4c=FILE --view a2c=FILE -o DIR
// echocine fit FILE FILE -o DIR

#include <filesystem>
#include <string>
#include <vector>

#include "fit/fit_files.h"

namespace CLI {
class App;
}

namespace echocine {

// A beating heart from one to three echo loops.
class FitCommand {
 public:
  explicit FitCommand(CLI::App& app);  // adds the sub-command
  int run();                           // exit code; throws JobError for a refused result

 private:
  std::vector<fit::FitFile> filesGiven() const;
  // Sets one member of the named view's options from each VIEW=NUMBER, of all loops from NUMBER.
  static void setNumbers(const char* option, const std::vector<std::string>& given, double low,
                         double high, std::vector<fit::FitFile>& files,
                         std::optional<double> echo::SideOptions::*member, double unit = 1);

  std::vector<std::string> files_, views_, scales_, ends_of_diastole_, ends_of_systole_, rates_;
  std::string dials_;
  double tilt_deg_ = fit::HeartFitOptions{}.tilt_deg;
  std::filesystem::path folder_;
  int threads_ = 0, resamples_ = 0;
  bool quiet_ = false, no_ecg_ = false, no_cache_ = false, resume_ = false, own_look_ = false,
       no_own_look_ = false;
};

}  // namespace echocine
