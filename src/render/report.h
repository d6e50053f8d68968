#pragma once
// report.html: a finished run on one page to look at.

#include <optional>
#include <utility>

#include "motion/cycle/cardiac_clock.h"
#include "output/manifest.h"
#include "page/page.h"

namespace echocine {

class ReportPage {
 public:
  // Of frames range.first up to, without, range.second. Does nothing where the scene asks for no
  // report. Throws JobError, as all functions here do. The references must outlive the page.
  ReportPage(const std::filesystem::path& path, const Scene& scene, const CardiacClock& clock,
             std::pair<int, int> range);

  // Whether the page shows this frame (pageStride()).
  bool shows(int frame) const;
  void addFrame(std::span<const std::byte> image);  // JPEG or PNG, in the order of frames
  void finish(const Manifest& manifest);            // with times and volumes filled in

 private:
  const Scene& scene_;
  const CardiacClock& clock_;
  std::pair<int, int> range_;
  int stride_;
  std::optional<PageWriter> writer_;
};

}  // namespace echocine
