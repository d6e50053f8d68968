#pragma once
// Writes a heart's files, and records a mark of each, by which a later run verifies them.

#include <filesystem>
#include <map>
#include <string>

#include "dataset/dataset_loop.h"

namespace echocine {
struct DicomLoop;
}

namespace echocine::dataset {

inline constexpr int kJpegQuality = 95;  // of all frames

struct FileMark {
  std::uint64_t bytes = 0;
  std::string digest;  // core/digest.h
};

class Sink {
 public:
  // `folder` of the dataset. The caller syncs files to disk.
  explicit Sink(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Writes a complete file by its name relative to the folder, and creates its folders. Throws
  // JobError.
  void write(const std::string& name, std::span<const std::byte> bytes);
  void write(const std::string& name, std::string_view text);
  // Motion JPEG of frames of equal size. Throws JobError.
  void writeCine(const std::string& name, std::span<const GreyImage* const> images,
                 double frame_rate_hz);

  // A DICOM loop of as many pictures as the header states. Throws JobError.
  void writeDicom(const std::string& name, std::span<const GreyImage* const> images,
                  const DicomLoop& header);

  // Notes a file that is already there with this mark.
  void note(const std::string& name, const FileMark& mark) { files_[name] = mark; }

  const std::filesystem::path& folder() const { return folder_; }
  // Path of a file; creates its folders.
  std::filesystem::path place(const std::string& name) const;
  const std::map<std::string, FileMark>& files() const { return files_; }

 private:
  std::filesystem::path folder_;
  std::map<std::string, FileMark> files_;
};

// The mark of a file on disk; none if it cannot be read.
std::optional<FileMark> markOf(const std::filesystem::path& file);

}  // namespace echocine::dataset
