#pragma once
// Where a heart's files go, and what is noted of each so that a later run can tell whether they are
// still there as they were written.

#include <filesystem>
#include <map>
#include <string>

#include "dataset/dataset_loop.h"

namespace echocine::dataset {

inline constexpr int kJpegQuality = 95;  // of all frames

struct FileMark {
  std::uint64_t bytes = 0;
  std::string digest;  // core/digest.h
};

class Sink {
 public:
  // `folder` of the dataset. The time that files are synced to disk is the caller's.
  explicit Sink(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // A whole file by its name relative to the folder, its folders made. Throws JobError.
  void write(const std::string& name, std::span<const std::byte> bytes);
  void write(const std::string& name, std::string_view text);
  // Motion JPEG of frames of equal size. Throws JobError.
  void writeCine(const std::string& name, std::span<const GreyImage* const> images,
                 double frame_rate_hz);

  const std::filesystem::path& folder() const { return folder_; }
  // Where a file goes, its folders made.
  std::filesystem::path place(const std::string& name) const;
  const std::map<std::string, FileMark>& files() const { return files_; }

 private:
  std::filesystem::path folder_;
  std::map<std::string, FileMark> files_;
};

// Of a file on the disk; nothing where it cannot be read.
std::optional<FileMark> markOf(const std::filesystem::path& file);

}  // namespace echocine::dataset
