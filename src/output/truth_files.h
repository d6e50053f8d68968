#pragma once
// The truth of frames as files: label pictures and contours.

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "output/frame_record.h"
#include "output/function_json.h"
#include "signal/picture.h"
#include "truth/frame_truth.h"

namespace echocine {

// Labels as a PNG for the eye, in colours by number; empty where none are asked for. The files hold
// greys.
std::vector<std::byte> colouredLabels(const Scene& scene, const FrameTruth& truth);

class TruthFiles {
 public:
  // Makes `folder` where the scene asks for truth files. References are kept.
  TruthFiles(std::filesystem::path folder, const Scene& scene, const LabelTable& labels);

  // Writes a frame's files. Thread-safe. Throws JobError.
  // Returns their digests by name, relative to the run's folder.
  std::map<std::string, std::string> write(const FrameRecord& record,
                                           const FrameTruth& truth) const;

  // Keeps what goes into one file of the whole loop. One call at a time, in the order of the
  // frames.
  void add(const FrameRecord& record, const FrameTruth& truth);

  // tracks.npz and function.json of the frames that were added.
  std::map<std::string, std::string> finish(const LoopTruth& loop) const;

  // The function of the frames that were added, one by one.
  std::span<const FunctionFrame> functions() const { return functions_; }

  // What holds for all frames: labels.json.
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
