#pragma once
// The dataset's own book-keeping below work/: of which spec the folder is, and a record of each
// finished heart, written when all its files are on the disk.

#include <filesystem>
#include <map>
#include <optional>

#include "dataset/layout.h"

namespace echocine::dataset {

class WorkFolder {
 public:
  // Makes the folder, or finds it as an earlier run of the same spec left it; another process may
  // be making it at this moment. Throws SceneError, nothing written, where it holds another spec's
  // dataset, files of something else or a link; JobError where it cannot be written.
  // The spec must outlive it.
  WorkFolder(std::filesystem::path folder, const Spec& spec);

  const std::filesystem::path& folder() const { return folder_; }

  // Notes a heart as finished with these files. Throws JobError.
  void finish(int heart, Json record, const std::map<std::string, FileMark>& files) const;

  // The record of a heart that is finished, and whose files are as it has them: by their sizes, or
  // by their bytes too. Otherwise nothing: `flaw` says what is wrong and names the file; it is
  // empty where the heart was never finished.
  enum class Look { sizes, bytes };
  struct Finished {
    std::optional<Json> record;
    std::string flaw;
  };
  Finished finished(int heart, Look look) const;

  // Half-written files of tasks that were killed. Nothing is removed while a task is at work.
  void removeParts() const;

 private:
  std::filesystem::path recordFile(int heart) const;
  std::filesystem::path folder_;
  const Spec& spec_;
};

}  // namespace echocine::dataset
