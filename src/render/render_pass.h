#pragma once
// The second pass of a loop: every frame to its files.

#include <map>
#include <memory>
#include <string>

#include "frame/simulator.h"
#include "output/exr_stack.h"
#include "output/output_folder.h"
#include "output/overlay.h"
#include "output/truth_files.h"
#include "render/reference_pass.h"
#include "render/render.h"
#include "render/report.h"
#include "video/cine_writer.h"

namespace echocine {

// SHA-256 over the resolved scene, its media, its meshes and the program's version: equal for two
// runs that must give the same files.
std::string sceneSha256(const Scene& scene, const MeshMotion& motion);

class RenderPass {
 public:
  struct Parts {
    const Simulator& simulator;
    const OutputFolder& folder;
    const Monitor& monitor;
    ReportPage& report;
    bool resume;
    std::map<std::string, std::string> earlier_hashes;  // on resuming, of an earlier manifest
  };
  // Frames, file hashes and reference go through `manifest`; `kept` frames are used up.
  RenderPass(const Parts& parts, Manifest& manifest, KeptFrames& kept);

  // Renders frames first..last-1; returns how many were finished.
  int run(int first, int last);

 private:
  struct Finished {
    FrameEntry entry;
    std::vector<std::byte> cine_frame;
    std::vector<std::byte> report_frame;  // where the cine's does not show in browsers
    std::string png_sha256;
    std::string mended;               // why a frame that was there is made again; empty: it is not
    std::optional<FrameTruth> truth;  // until it is written
    std::map<std::string, std::string> truth_files;  // name -> SHA-256
    PageTruth page_truth;
  };

  std::shared_ptr<Finished> make(int frame);
  void takeEarlier(const FrameRecord& record, Finished& finished) const;
  Volumes tracedFrame(const FrameTime& time, Workspace& workspace);
  void writeExr(const FrameRecord& record, const Workspace& workspace, Finished& finished);
  void makeTruth(const FrameTime& time, const Workspace& workspace, Finished& finished);
  void writePictures(GreyImage& image, Finished& finished);
  void finishTruth();
  void drain(Finished& finished);
  void endEarly();

  const Parts parts_;
  Manifest& manifest_;
  KeptFrames& kept_;
  std::mutex kept_mutex_;
  ExrStack exr_;
  Overlay overlay_;
  CineWriter cine_;
  std::optional<TruthFiles> truth_files_;
};

}  // namespace echocine
