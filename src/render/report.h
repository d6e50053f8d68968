#pragma once
// report.html: a finished run on one page.

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <utility>

#include "frame/simulator.h"
#include "motion/cycle/cardiac_clock.h"
#include "output/manifest.h"
#include "page/page.h"
#include "truth/frame_truth.h"

namespace echocine {

// A frame's truth for the page's overlay.
struct PageTruth {
  struct Outline {
    std::size_t structure;
    bool closed;
    std::vector<float> px;  // x, y, x, y, ...
  };
  std::vector<Outline> outlines;
  std::vector<float> tracks_px;   // x, y, x, y, ...
  std::vector<std::byte> labels;  // PNG; empty if not requested
};

// Contours within the picture, thinned to a pixel and a half, and some hundred material points.
PageTruth pageTruth(const FrameTruth& truth, const Scene& scene, std::vector<std::byte> labels);

class ReportPage {
 public:
  // Page for frames range.first to range.second - 1. Does nothing if the scene requests no report.
  // Throws JobError, as all functions here do. The references must outlive the page.
  ReportPage(const std::filesystem::path& path, const Scene& scene, const CardiacClock& clock,
             std::pair<int, int> range);
  ~ReportPage();

  // Does the page show this frame (pageStride())?
  bool shows(int frame) const;
  void addFrame(std::span<const std::byte> image);  // JPEG or PNG, in the order of frames
  void addTruth(PageTruth truth);                   // of the frame added last
  // Prepares the 3-D view, which finish() otherwise does. May run beside addFrame() and addTruth().
  // Throws nothing: finish() meets an error again.
  void prepareView(const Simulator& simulator);
  // The manifest must have times and volumes. Also shows the simulator's surfaces in 3-D.
  void finish(const Manifest& manifest, const Simulator& simulator);

 private:
  const Scene& scene_;
  const CardiacClock& clock_;
  std::pair<int, int> range_;
  int stride_;
  std::optional<PageWriter> writer_;
  std::vector<PageTruth> truths_;  // by shown frame, without label pictures
  std::unique_ptr<const nlohmann::ordered_json> view_;
};

}  // namespace echocine
