#pragma once
// Whole files in, whole files out.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace echocine {

// The text of a file. Throws SceneError when it cannot be read or is larger than max_bytes.
std::string readTextFile(const std::filesystem::path& path, std::size_t max_bytes);

// Makes the folder and those it lies in, if they are not there. Throws JobError.
void makeFolder(const std::filesystem::path& folder);

// Has the disk hold what was written to a descriptor. False, with errno, when it cannot.
bool syncFile(int descriptor);

// Has the disk hold the names in a file's folder, as far as the file system can; after a rename.
void syncFolderOf(const std::filesystem::path& path);

// A file written in pieces beside its target and renamed at the end, so that the target is either
// as before or whole. Destroyed without finish() it leaves nothing behind.
class WholeFile {
 public:
  explicit WholeFile(std::filesystem::path path);  // throws JobError, as write() and finish() do
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void finish();

 private:
  [[noreturn]] void fail(int reason);
  void discard();

  std::filesystem::path path_;
  std::string part_;
  int descriptor_ = -1;
};

// Writes beside the target and renames, so that the target is either as before or whole.
// Throws JobError with the system's reason (disk full, no permission), the target untouched.
void writeFileWhole(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace echocine
