#pragma once
// What a dataset will look like, before anything long starts: some hearts at end-diastole and
// end-systole, what is drawn for all, and what the whole takes.

#include <filesystem>

#include "core/monitor.h"
#include "dataset/spec.h"

namespace echocine::dataset {

struct PreviewSummary {
  int pictures = 0;    // pairs on the sheet
  int impossible = 0;  // draws before them that no heart fulfilled
  double seconds = 0;  // of the whole dataset, expected on these threads
  double bytes = 0;    // of its files, expected
};

// Writes `page` (HTML) and beside it, under the same name, the contact sheet as PNG: the first
// `hearts` hearts, each in one of the spec's views in turn, end-diastole left of end-systole. Time
// and disk are those of the first heart, made whole and thrown away, times the number of hearts.
// monitor.tell() counts hearts. Throws SceneError where a heart cannot be drawn, JobError where
// files cannot be written or the monitor stops.
PreviewSummary writePreview(const Spec& spec, const std::filesystem::path& page, int hearts,
                            int threads, const Monitor& monitor);

}  // namespace echocine::dataset
