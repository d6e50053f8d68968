#pragma once
// The folder of a study while it runs: study.json, study.csv, study.html.

#include <chrono>
#include <filesystem>
#include <optional>

#include "study/study.h"

namespace echocine {

class StudyFolder {
 public:
  // Removes parts of these files, of a run that was killed here.
  explicit StudyFolder(std::filesystem::path folder);

  // After every row, so that a stopped study leaves whole files. The page holds all pictures, so it
  // follows every few seconds (our choice) and with the last call. Not stopped halfway. Throws
  // JobError.
  void write(const StudyResult& result, bool last);

 private:
  const std::filesystem::path folder_;
  std::optional<std::chrono::steady_clock::time_point> page_;
};

}  // namespace echocine
