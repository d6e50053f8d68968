#pragma once
// Preview of a dataset: some hearts at end-diastole and end-systole, the distributions of all
// draws, and the cost of the whole.

#include <filesystem>

#include "core/monitor.h"
#include "dataset/spec.h"

namespace echocine::dataset {

struct PreviewSummary {
  int pictures = 0;    // pairs on the sheet
  int impossible = 0;  // draws without a valid heart before them
  double seconds = 0;  // for the whole dataset, expected on these threads
  double bytes = 0;    // of its files, expected
};

// Writes `page` (HTML) and, under the same name, the contact sheet as PNG: the first `hearts`
// hearts in one view each, by turns, end-diastole left of end-systole. Time and disk space are
// those of the first heart, rendered and deleted, times the number of hearts. monitor.tell() counts
// hearts. Throws SceneError if a heart cannot be drawn, JobError if files cannot be written or the
// monitor stops.
PreviewSummary writePreview(const Spec& spec, const std::filesystem::path& page, int hearts,
                            int threads, const Monitor& monitor);

}  // namespace echocine::dataset
