#pragma once
// One run at a time in a folder.

#include <filesystem>

namespace echocine {

// Holds the folder itself locked (flock), so nothing is left behind however the program ends. Where
// a file system has no such locks there is no protection.
class FolderLock {
 public:
  // Precondition: the folder is there. Throws JobError when another run holds it.
  explicit FolderLock(std::filesystem::path folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  // Throws JobError when the path no longer leads to the folder that was locked: it was removed,
  // renamed or replaced, and what is there now may be another run's.
  void checkStillThere() const;

 private:
  std::filesystem::path folder_;
  int descriptor_;
};

// Whether another run holds the folder at this moment. False where there is no such folder.
bool isLocked(const std::filesystem::path& folder);

}  // namespace echocine
