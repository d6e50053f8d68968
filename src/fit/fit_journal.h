#pragma once
// Evaluations of a fit in a file: a fit that was stopped repeats its search without repeating them.

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/file_lock.h"
#include "fit/plane_tilt.h"
#include "fit/pose_search.h"

namespace echocine::fit {

// One record for each evaluated heart: a digest of what was evaluated, and the pose found. The
// search is deterministic, so a resumed fit has the result of one that was never stopped. Records
// are appended; a damaged one ends the file. Beside the file, fit.lock is held. Thread-safe.
class FitJournal {
 public:
  static constexpr const char* kLock = "fit.lock";

  // `fit`: digest of everything that the evaluations depend on. Reads the records of an earlier
  // run, if the file exists; otherwise the first record creates it, with its folder. Throws
  // SceneError if the records are of another fit, JobError if the file cannot be read or another
  // run has it.
  FitJournal(std::filesystem::path file, const std::string& fit);

  // A heart of a view at values of the unknowns; `from`: the pose it is refined from, none: global
  // search. `stage` names the loops and the beat that it is compared with.
  static std::string keyOf(const std::string& stage, std::size_t view,
                           const std::vector<double>& values, const PlaneTilt& tilt,
                           const FitPose* from);
  std::optional<PoseFound> find(const std::string& key) const;
  // Throws JobError if it cannot be written.
  void add(const std::string& key, const PoseFound& found);

  std::size_t size() const;  // records
  // Removes the file. Later records are not kept.
  void finish();

 private:
  void read();
  void append(std::span<const std::byte> bytes);

  std::filesystem::path file_;
  std::string fit_;
  std::optional<FileLock> lock_;
  std::ofstream out_;
  mutable std::mutex mutex_;
  std::map<std::string, PoseFound> records_;
  bool finished_ = false;
};

// The part of a journal that one stage of a fit uses; without a journal nothing is kept.
struct FitMemory {
  std::shared_ptr<FitJournal> journal{};
  std::string stage{};
};

}  // namespace echocine::fit
