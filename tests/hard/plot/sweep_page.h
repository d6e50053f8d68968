#pragma once
// sweeps.html: the sweeps across hard cases as plots, each with its bound.

#include <filesystem>
#include <vector>

#include "sweep_files.h"

namespace echocine {

// Throws JobError.
void writeSweepPage(const std::vector<HardCaseSweep>& sweeps, const std::filesystem::path& path);

}  // namespace echocine
