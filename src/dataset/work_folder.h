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
  // Makes the folder, or finds it as an earlier run of the same spec left it. Throws SceneError,
  // nothing written, where it holds another spec's dataset or files of something else; JobError
  // where it cannot be written.
  WorkFolder(std::filesystem::path folder, const Spec& spec);

  const std::filesystem::path& folder() const { return folder_; }

  // Notes a heart as finished with these files. Throws JobError.
  void finish(int heart, Json record, const std::map<std::string, FileMark>& files) const;

  // The record of a heart that is finished; nothing where it is not, or not by this spec. How its
  // files are looked at: by their names and sizes, or by their bytes too.
  enum class Look { sizes, bytes };
  std::optional<Json> finished(int heart, Look look) const;

 private:
  std::filesystem::path recordFile(int heart) const;
  std::filesystem::path folder_;
  std::string digest_;
};

}  // namespace echocine::dataset
