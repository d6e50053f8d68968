#pragma once
// Files that reach the disk together: one flush serves many.

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace echocine {

// A complete file under a temporary name beside its target, which is unchanged until a FileGroup
// finishes. Destroyed before, it leaves no file.
class PendingFile {
 public:
  PendingFile() = default;
  // Writes the bytes. Throws JobError with the system's reason.
  PendingFile(std::filesystem::path path, std::span<const std::byte> bytes);
  ~PendingFile();
  PendingFile(PendingFile&& other) noexcept;
  PendingFile& operator=(PendingFile&& other) noexcept;

  bool empty() const { return part_.empty(); }

 private:
  friend class FileGroup;
  void discard();

  std::filesystem::path path_;
  std::string part_;  // empty: nothing pending
};

class FileGroup {
 public:
  // Empty files are ignored.
  void add(PendingFile file);

  // Should the group finish, so that a kill costs little? True from 32 files on, or if the first
  // was added two seconds ago.
  bool isDue() const;

  // Flushes the data of all files, renames them in the order of add(), and flushes each folder
  // once. The target of every file is then complete, also after a power loss. Throws JobError;
  // files that are not yet renamed are removed. The group is then empty.
  void finish();

 private:
  std::vector<PendingFile> files_;
  std::chrono::steady_clock::time_point first_added_;
};

}  // namespace echocine
