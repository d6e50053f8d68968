#pragma once
// Exclusive use of a folder by one run.

#include <filesystem>

namespace echocine {

// Locks the folder itself (flock), so no lock file remains after any kind of exit. On a file system
// without such locks there is no protection.
class FolderLock {
 public:
  // Precondition: the folder exists. Throws JobError if another run holds it.
  explicit FolderLock(std::filesystem::path folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  // Throws JobError if the path no longer leads to the locked folder: it was removed, renamed or
  // replaced, possibly by another run's.
  void checkStillThere() const;

 private:
  std::filesystem::path folder_;
  int descriptor_;
};

}  // namespace echocine
