#pragma once
// Finished datasets of different specs, joined in a new folder.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/monitor.h"

namespace echocine::dataset {

struct JoinOptions {
  std::optional<std::string> name;  // of the joined dataset; default: "FIRST + SECOND", by parts
};

struct JoinSummary {
  std::size_t hearts = 0, loops = 0, failed = 0;
  std::vector<std::string> left_out;  // layouts that not all parts have
};

// Copies the loops of all parts into `folder`, which is new, empty or of an interrupted join of the
// same parts, and writes the lists of their common layouts, tables and card. Hearts of the first
// part keep their numbers; those of the next part follow, so all names stay apart. Splits are kept.
// The parts are not changed. Throws SceneError, before anything is written, if fewer than two parts
// are given, if a part is no finished dataset of this program version or has another kind of EF or
// of nnU-Net labels, if no layout is common, if a heart or a scene in two splits would be there
// twice, and if the name is empty or has control characters; JobError if a file of a part is
// damaged, if files cannot be written, or if stopped.
JoinSummary joinDatasets(const std::vector<std::filesystem::path>& parts,
                         const std::filesystem::path& folder, const JoinOptions& options = {},
                         const Monitor& monitor = {});

}  // namespace echocine::dataset
