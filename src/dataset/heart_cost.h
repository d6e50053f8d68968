#pragma once
// Measured cost of a heart of a dataset.

#include <filesystem>

#include "core/monitor.h"
#include "dataset/spec.h"

namespace echocine::dataset {

struct HeartCost {
  double seconds = 0;    // on one core
  double bytes = 0;      // of its files
  double memory_mb = 0;  // largest resident memory of this process up to its end, 2^20 bytes
};

// Renders the first heart completely beside `output` (a page or a folder) and deletes it. Throws
// like makePart(), and Stopped when the monitor requests a stop.
HeartCost costOfAHeart(const Spec& spec, const std::filesystem::path& output,
                       const Monitor& monitor);

}  // namespace echocine::dataset
