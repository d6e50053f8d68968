#pragma once
// Terminal output of `echocine compare`.

#include <filesystem>

#include "compare/compare.h"
#include "fit/dial_scan.h"
#include "fit/view_ranking.h"

namespace echocine {

void printTable(const compare::Comparison& c, const std::filesystem::path& folder);
void printTable(const fit::DialScan& scan, const std::filesystem::path& folder);
void printTable(const fit::ViewRanking& ranking, const std::filesystem::path& folder);

}  // namespace echocine
