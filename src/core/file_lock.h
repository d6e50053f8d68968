#pragma once
// A lock file that only one run holds at a time.

#include <filesystem>

namespace echocine {

// flock() on a file opened for writing, as NFS requires it. The file is removed at the end; after a
// kill it stays, without a lock. On a file system without such locks there is no protection.
class FileLock {
 public:
  // Creates the file and its folder if needed. Throws JobError if another run holds it, or if it
  // cannot be opened.
  explicit FileLock(std::filesystem::path file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  // Throws JobError if the path no longer leads to the locked file.
  void checkStillThere() const;

 private:
  bool isStillThere() const;
  std::filesystem::path file_;
  int descriptor_;
};

// Does another run hold the file now? False for a missing file.
bool isFileLocked(const std::filesystem::path& file);

}  // namespace echocine
