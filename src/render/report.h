#pragma once
// report.html: a finished run on one page to look at.

#include <optional>
#include <utility>

#include "frame/simulator.h"
#include "motion/cycle/cardiac_clock.h"
#include "output/manifest.h"
#include "page/page.h"
#include "truth/frame_truth.h"

namespace echocine {

// A frame's truth as the page draws it over the picture.
struct PageTruth {
  struct Outline {
    std::size_t structure;
    bool closed;
    std::vector<float> px;  // x, y, x, y, ...
  };
  std::vector<Outline> outlines;
  std::vector<float> tracks_px;   // x, y, x, y, ...
  std::vector<std::byte> labels;  // PNG; empty where none are asked for
};

// Contours within the picture, without points that lie within a pixel and a half of the last, and
// some hundred material points.
PageTruth pageTruth(const FrameTruth& truth, const Scene& scene, std::vector<std::byte> labels);

class ReportPage {
 public:
  // Of frames range.first up to, without, range.second. Does nothing where the scene asks for no
  // report. Throws JobError, as all functions here do. The references must outlive the page.
  ReportPage(const std::filesystem::path& path, const Scene& scene, const CardiacClock& clock,
             std::pair<int, int> range);

  // Whether the page shows this frame (pageStride()).
  bool shows(int frame) const;
  void addFrame(std::span<const std::byte> image);  // JPEG or PNG, in the order of frames
  void addTruth(PageTruth truth);                   // of the frame that was added last
  // With times and volumes filled in; shows the simulator's surfaces in space too.
  void finish(const Manifest& manifest, const Simulator& simulator);

 private:
  const Scene& scene_;
  const CardiacClock& clock_;
  std::pair<int, int> range_;
  int stride_;
  std::optional<PageWriter> writer_;
  std::vector<PageTruth> truths_;  // by shown frame, without their labels
};

}  // namespace echocine
