#pragma once
// The whole dataset in one call: a spec in, a folder of loops with ground truth out.

#include <filesystem>

#include "core/monitor.h"
#include "dataset/real_loops.h"
#include "dataset/spec.h"

namespace echocine::dataset {

struct MakeOptions {
  std::filesystem::path folder;
  int threads = 0;          // 0: one per core
  int task = 1, tasks = 1;  // this run's part: every tasks-th heart, starting at the task-th
};

struct MakeSummary {
  std::size_t loops = 0, bytes = 0;  // of the folder, new and kept
  std::size_t kept = 0;              // hearts that were already finished
  std::size_t impossible = 0;        // draws without a valid heart
  std::size_t failed = 0;            // hearts whose rendering failed; listed in failed.csv
  std::size_t merged = 0;            // hearts in the tables; 0 before merge
};

// Renders a part of the hearts. Finished hearts are kept if their records and files are unchanged,
// byte by byte; monitor.warn() names changed ones, and their hearts are rendered again.
// monitor.tell() counts hearts. Throws SceneError if the folder belongs to another spec (nothing is
// written), JobError if files cannot be written or the monitor stops; finished hearts stay.
MakeSummary makePart(const Spec& spec, const MakeOptions& options, const Monitor& monitor);

struct MergeOptions {
  bool fast = false;             // compares the sizes of files only, not their bytes
  int threads = 0;               // 0: one per core
  std::vector<RealLoop> real{};  // the card compares the dataset with them; needs "native"
};

// Writes tables, splits, card and the layouts' own lists from all records, after verification of
// all records and files. Throws JobError naming missing or damaged hearts, if all hearts failed,
// and while another merge runs; SceneError for real loops that cannot be compared, before anything
// is written. monitor.warn() names the damaged files.
MakeSummary mergeParts(const Spec& spec, const std::filesystem::path& folder,
                       const MergeOptions& options = {}, const Monitor& monitor = {});

}  // namespace echocine::dataset
