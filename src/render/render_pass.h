#pragma once
// The sink of a loop that is written to a folder: every frame as files.

#include <map>
#include <memory>
#include <string>

#include "core/file_group.h"
#include "frame/simulator.h"
#include "loop/render_frames.h"
#include "output/exr_stack.h"
#include "output/output_folder.h"
#include "output/overlay.h"
#include "output/scene_sha256.h"
#include "output/truth_files.h"
#include "render/loop_files.h"
#include "render/render.h"
#include "render/report.h"

namespace echocine {

class FolderSink : public FrameSink {
 public:
  struct Parts {
    const Simulator& simulator;
    const OutputFolder& folder;
    const Monitor& monitor;
    ReportPage& report;
    std::pair<int, int> range;  // first frame and one past the last
    bool resume;
    std::map<std::string, std::string> earlier_hashes;  // when resuming: from an earlier manifest
  };
  // Adds frames, file hashes and white to `manifest`. References are kept.
  FolderSink(const Parts& parts, Manifest& manifest);

  void begin(double white) override;
  std::shared_ptr<void> take(MadeFrame& frame) override;
  void inOrder(void* taken) override;

  // After the last frame. whole: false for an interrupted run.
  void finish(bool whole);
  // The run has failed: makes the existing part of the cine playable.
  void endEarly();

 private:
  struct Finished {
    FrameEntry entry;
    LoopFiles::Frame loop;
    std::vector<std::byte> report_frame;  // if browsers cannot show the cine's frames
    std::string png_sha256;
    std::string mended;               // reason for rendering an existing frame again; empty: kept
    std::optional<FrameTruth> truth;  // until it is written
    std::map<std::string, std::string> truth_files;  // name -> SHA-256
    PageTruth page_truth;
    std::vector<PendingFile> files;  // get their names in the order of frames
  };

  void takeEarlier(const FrameRecord& record, Finished& finished) const;
  void writeExr(const FrameRecord& record, const Workspace& workspace, Finished& finished);
  void writeTruth(Finished& finished);
  void writePictures(GreyImage& image, Finished& finished);
  void finishTruth();

  const Parts parts_;
  Manifest& manifest_;
  // From begin() on.
  std::optional<ExrStack> exr_;
  std::optional<Overlay> overlay_;
  std::optional<LoopFiles> loop_;
  std::optional<TruthFiles> truth_files_;
  FileGroup group_;
};

}  // namespace echocine
