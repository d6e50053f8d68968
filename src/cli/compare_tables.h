#pragma once
// What `echocine compare` prints.

#include <filesystem>

#include "compare/compare.h"
#include "compare/dial_scan.h"
#include "compare/view_ranking.h"

namespace echocine {

void printTable(const compare::Comparison& c, const std::filesystem::path& folder);
void printTable(const compare::DialScan& scan, const std::filesystem::path& folder);
void printTable(const compare::ViewRanking& ranking, const std::filesystem::path& folder);

}  // namespace echocine
