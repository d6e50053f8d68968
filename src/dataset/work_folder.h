#pragma once
// The dataset's own state in work/: the spec of the folder, and a record of each finished heart,
// written after all its files are on disk.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dataset/layout.h"

namespace echocine::dataset {

// The lock of a task is in work/task_K_of_N, that of a merge in work/merge (core/file_lock.h).
inline constexpr const char* kLockName = "lock";

// Present in folders of joined datasets (join.h).
inline constexpr const char* kJoinedMark = "work/joined.json";
bool isJoined(const std::filesystem::path& folder);

// The record of a heart, from 0.
std::filesystem::path recordFile(const std::filesystem::path& folder, int heart);

class WorkFolder {
 public:
  // Creates the folder or opens that of an earlier run of the same spec; another process may create
  // it concurrently. Throws SceneError, and writes nothing, if it contains another spec's dataset,
  // other files or a link; JobError if it cannot be written. The spec must outlive it.
  WorkFolder(std::filesystem::path folder, const Spec& spec);

  const std::filesystem::path& folder() const { return folder_; }

  // Records a heart as finished with these files. Throws JobError.
  void finish(int heart, Json record, const std::map<std::string, FileMark>& files) const;

  // The record of a finished heart whose files match it, by size, or also by content. Otherwise
  // none: `flaw` names the fault and the file; it is empty if the heart was never finished.
  enum class Look { sizes, bytes };
  struct Finished {
    std::optional<Json> record;
    std::string flaw;
  };
  Finished finished(int heart, Look look) const;

  // Removes temporary files and locks of killed tasks. Removes nothing while a task is running.
  void removeParts() const;

  // Names of the tasks that run now, such as "task_3_of_8".
  std::vector<std::string> runningTasks() const;

 private:
  std::filesystem::path folder_;
  const Spec& spec_;
};

}  // namespace echocine::dataset
