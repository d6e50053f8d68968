#pragma once
// Reading and writing of whole files.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "core/part_file.h"

namespace echocine {

// The text of a file. Throws SceneError when it cannot be read or is larger than max_bytes.
std::string readTextFile(const std::filesystem::path& path, std::size_t max_bytes);

// Creates the folder and its parents if they do not exist. Throws JobError.
void makeFolder(const std::filesystem::path& folder);

// Flushes a descriptor's data to disk. False, with errno, on failure.
bool syncFile(int descriptor);

// Flushes the names in a file's folder to disk, if the file system can; for use after a rename.
void syncFolderOf(const std::filesystem::path& path);

// Writes a new file into a folder that gets its name later: neither synced nor renamed. Throws
// JobError, also if the file exists.
void writeNewFile(const std::filesystem::path& path, std::span<const std::byte> bytes);

// Writes the bytes to a new part of `path`, not synced. Returns its name. Throws JobError; no part
// is left then.
std::string writePart(const std::filesystem::path& path, std::span<const std::byte> bytes);

// Flushes the file system of a folder to the disk: all files and names below it with one call.
// Throws JobError.
void syncAllOf(const std::filesystem::path& folder);

// A file written in pieces under a temporary name and renamed at the end, so the target is either
// unchanged or complete. Destroyed without finish() it leaves no file.
class WholeFile {
 public:
  explicit WholeFile(std::filesystem::path path);  // throws JobError, as write() and finish() do
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void finish();
  bool finishOnce();  // false, and no file is left, if the target already exists

 private:
  void close();
  [[noreturn]] void fail(int reason);
  void discard();

  std::filesystem::path path_;
  PartFile part_;
};

// Is the path itself an ordinary file: not a link, a pipe or a folder?
bool isOrdinaryFile(const std::filesystem::path& path);

// The first part of `name` below `folder` that is a link, as a path; empty if none is. The folder
// itself may be reached through links.
std::filesystem::path linkBelow(const std::filesystem::path& folder,
                                const std::filesystem::path& name);

// Like writeFileWhole(), but returns false and changes nothing if the name exists, even if another
// process creates it concurrently. Throws JobError.
bool writeFileOnce(const std::filesystem::path& path, std::span<const std::byte> bytes);

// Writes a temporary file and renames it, so the target is either unchanged or complete. Throws
// JobError with the system's reason (disk full, no permission); the target is then unchanged.
void writeFileWhole(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace echocine
