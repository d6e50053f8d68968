#pragma once
// The files that hold the pictures of a whole loop: AVI and DICOM.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "frame/simulator.h"
#include "output/output_folder.h"
#include "video/cine_writer.h"
#include "video/dicom_writer.h"

namespace echocine {

class LoopFiles {
 public:
  // A frame in each file; empty for files that the scene does not request.
  struct Frame {
    std::vector<std::byte> cine, dicom;
  };

  // The loop has the frames range.first to range.second - 1. References are not kept. Nothing is
  // written before the first frame.
  LoopFiles(const OutputFolder& folder, const Simulator& simulator, std::pair<int, int> range,
            const std::string& scene_sha256);

  // Thread-safe. Throws JobError, as all functions below do.
  Frame encode(const GreyImage& image) const;
  void add(const Frame& frame);  // in order

  // After the last frame: the names and SHA-256 of the files.
  std::map<std::string, std::string> finish();

  // After a stop: a playable cine, unless there is a longer one. Other files stay as
  // they were. After add() has thrown it changes nothing.
  void finishEarly();

 private:
  OutputSettings output_;
  std::filesystem::path cine_path_, dicom_path_;
  std::optional<CineWriter> cine_;
  std::optional<DicomWriter> dicom_;
};

}  // namespace echocine
