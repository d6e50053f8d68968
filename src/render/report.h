#pragma once
// report.html: a finished run on one page to look at.

#include <optional>
#include <utility>

#include "motion/cycle/cardiac_clock.h"
#include "output/manifest.h"
#include "page/page.h"
#include "signal/picture.h"
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
  std::vector<std::byte> labels;  // PNG; empty where none are asked for
};

// Contours within the picture, without points that lie within a pixel and a half of the last.
std::vector<PageTruth::Outline> pageOutlines(const FrameTruth& truth, const Scene& scene);

class ReportPage {
 public:
  // Of frames range.first up to, without, range.second. Does nothing where the scene asks for no
  // report. Throws JobError, as all functions here do. The references must outlive the page.
  ReportPage(const std::filesystem::path& path, const Scene& scene, const CardiacClock& clock,
             std::pair<int, int> range);

  // Whether the page shows this frame (pageStride()).
  bool shows(int frame) const;
  void addFrame(std::span<const std::byte> image);  // JPEG or PNG, in the order of frames
  // Of the frame that was added last. tracks_m: material points, the same in every frame.
  void addTruth(const PageTruth& truth, std::span<const Vec3f> tracks_m);
  void finish(const Manifest& manifest);  // with times and volumes filled in

 private:
  const Scene& scene_;
  const CardiacClock& clock_;
  std::pair<int, int> range_;
  int stride_;
  std::optional<PageWriter> writer_;
  PictureGeometry picture_;
  std::vector<std::vector<PageTruth::Outline>> outlines_;  // by shown frame
  std::vector<std::vector<float>> tracks_px_;
};

}  // namespace echocine
