#pragma once
// The whole dataset in one call: a spec in, a folder of loops with truth out.

#include <filesystem>

#include "core/monitor.h"
#include "dataset/spec.h"

namespace echocine::dataset {

struct MakeOptions {
  std::filesystem::path folder;
  int threads = 0;          // 0: one per core
  int task = 1, tasks = 1;  // this run's part: every tasks-th heart from the task-th on
};

struct MakeSummary {
  std::size_t loops = 0, bytes = 0;  // of the folder, made now or before
  std::size_t kept = 0;              // hearts that were finished before
  std::size_t impossible = 0;        // draws that no heart fulfilled
  std::size_t failed = 0;            // hearts that could not be made; listed in failed.csv
  std::size_t merged = 0;            // hearts in the tables; 0 before merge
};

// Makes a part of the hearts; those that an earlier run finished are kept when their records and
// files are as they were written, byte by byte. monitor.warn() names what is not, and its heart is
// made anew. monitor.tell() counts hearts. Throws SceneError where the folder is another
// spec's (nothing is written), JobError where files cannot be written or the monitor stops; what is
// finished stays.
MakeSummary makePart(const Spec& spec, const MakeOptions& options, const Monitor& monitor);

struct MergeOptions {
  bool fast = false;  // files are looked at by their sizes, not by their bytes
  int threads = 0;    // 0: one per core
};

// Tables, splits, card and the layouts' own lists from all hearts' records, after all records and
// files were proven to be as they were written. Throws JobError naming the hearts that are missing
// or damaged; monitor.warn() names the damaged files.
MakeSummary mergeParts(const Spec& spec, const std::filesystem::path& folder,
                       const MergeOptions& options = {}, const Monitor& monitor = {});

}  // namespace echocine::dataset
