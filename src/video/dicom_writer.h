#pragma once
// The loop as a DICOM file, written frame by frame under a temporary name and renamed.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "core/file.h"
#include "signal/picture.h"
#include "video/dicom_header.h"

namespace echocine {

// A frame's pixels as they stand in the file: RGB, or a JPEG whose luma is that of the AVI's.
// Thread-safe. Throws JobError.
std::vector<std::byte> encodeDicomFrame(const GreyImage& image, const OutputSettings& output);

// Throws SceneError if the pixels without compression need 4 GiB or more, which a length of 32 bits
// cannot state.
void refuseLargeDicom(const OutputSettings& output, int frames);

// Memory does not grow with the number of frames. A writer destroyed without finish() leaves no
// file.
class DicomWriter {
 public:
  DicomWriter(std::filesystem::path path, DicomLoop loop);

  // A frame of encodeDicomFrame(), in order. Throws JobError (disk full, ...), as finish() does;
  // the writer can then only be destroyed.
  void add(std::span<const std::byte> encoded_frame);
  // Precondition: as many frames as the loop states.
  void finish();

 private:
  std::filesystem::path path_;
  DicomLoop loop_;
  std::optional<WholeFile> file_;  // from the first frame on
  int frames_ = 0;
};

}  // namespace echocine
