#pragma once
// Ground truth of frames as files: label pictures and contours.

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/file_group.h"
#include "output/frame_record.h"
#include "output/function_json.h"
#include "signal/picture.h"
#include "truth/frame_truth.h"

namespace echocine {

// Labels as a coloured PNG for the page; empty if not requested. The files hold grey levels.
std::vector<std::byte> colouredLabels(const Scene& scene, const FrameTruth& truth);

class TruthFiles {
 public:
  // Creates `folder` if the scene requests truth files. References are kept.
  TruthFiles(std::filesystem::path folder, const Scene& scene, const LabelTable& labels);

  // Writes a frame's files, which get their names with a FileGroup. Thread-safe. Throws JobError.
  // Returns their digests by name, relative to the run's folder.
  std::map<std::string, std::string> write(const FrameRecord& record, const FrameTruth& truth,
                                           std::vector<PendingFile>& pending) const;

  // Collects data for the files of the whole loop. One call at a time, in the order of the frames.
  void add(const FrameRecord& record, const FrameTruth& truth);

  // tracks.npz and function.json of the added frames.
  std::map<std::string, std::string> finish(const LoopTruth& loop) const;

  // The function of the added frames, one entry each.
  std::span<const FunctionFrame> functions() const { return functions_; }

  // Files that are common to all frames: labels.json.
  std::map<std::string, std::string> writeTables() const;

 private:
  std::vector<std::byte> tracksFile(std::span<const TruthMaker::Tracked> tracked) const;
  std::vector<std::byte> labelPicture(const FrameTruth& truth) const;
  std::string contoursText(const FrameRecord& record, const FrameTruth& truth) const;
  std::string put(const std::string& name, std::span<const std::byte> bytes) const;

  std::filesystem::path folder_;
  const Scene& scene_;
  const LabelTable& labels_;
  PictureGeometry geometry_;
  std::vector<Vec3d> outline_;
  std::vector<FrameRecord> records_;
  std::vector<FunctionFrame> functions_;
  std::vector<float> tracks_mm_, tracks_px_, out_of_plane_mm_;
  std::vector<std::uint8_t> tracks_visible_;
};

}  // namespace echocine
