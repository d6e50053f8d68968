#pragma once
// compare.html: the two loops, their difference and every number on one page.

#include "compare/panels.h"
#include "page/page.h"

namespace echocine::compare {

class ComparePage {
 public:
  // The comparison must outlive the page. Throws JobError, as all functions here do.
  ComparePage(const std::filesystem::path& path, const Comparison& comparison);

  // Does the page show this real frame (pageStride())?
  bool shows(int real_frame) const { return real_frame % stride_ == 0; }
  // JPEG or PNG, in the order of frames.
  void addFrame(Panel panel, std::span<const std::byte> image);
  // `summary` is summaryJson(); the sectors are PNG pictures.
  void finish(const nlohmann::ordered_json& summary, std::span<const std::byte> sector_real,
              std::span<const std::byte> sector_synthetic);

 private:
  const Comparison& c_;
  int stride_;
  PageWriter writer_;
};

}  // namespace echocine::compare
