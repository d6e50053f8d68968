#pragma once
// What a heart of a dataset takes: measured, not modelled.

#include <filesystem>

#include "core/monitor.h"
#include "dataset/spec.h"

namespace echocine::dataset {

struct HeartCost {
  double seconds = 0;  // on one core
  double bytes = 0;    // of its files
};

// Of the first heart, made whole beside `output` (a page or a folder) and thrown away. Throws as
// makePart() does.
HeartCost costOfAHeart(const Spec& spec, const std::filesystem::path& output,
                       const Monitor& monitor);

}  // namespace echocine::dataset
