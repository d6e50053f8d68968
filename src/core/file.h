#pragma once
// Whole files in, whole files out.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "core/part_file.h"

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
  bool finishOnce();  // false, and nothing left behind, where the target is there already

 private:
  void close();
  [[noreturn]] void fail(int reason);
  void discard();

  std::filesystem::path path_;
  PartFile part_;
};

// Whether an ordinary file stands at the path itself: no link to one, no pipe, no folder.
bool isOrdinaryFile(const std::filesystem::path& path);

// The first part of `name` below `folder` that is a link, as a path; empty where none is. The
// folder itself may be reached through links.
std::filesystem::path linkBelow(const std::filesystem::path& folder,
                                const std::filesystem::path& name);

// As writeFileWhole(), but false, and nothing changed, where the name is taken already, by another
// process at this very moment too. Throws JobError.
bool writeFileOnce(const std::filesystem::path& path, std::span<const std::byte> bytes);

// Writes beside the target and renames, so that the target is either as before or whole.
// Throws JobError with the system's reason (disk full, no permission), the target untouched.
void writeFileWhole(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace echocine
