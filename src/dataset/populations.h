#pragma once
// Named populations of hearts: distributions of their dials, with sources.

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/distribution.h"

namespace echocine::dataset {

// By parameter, such as "ef" or "segments.lad.amplitude".
using DialDistributions = std::map<std::string, Distribution>;

// Names of the built-in populations, in the order of messages.
std::vector<std::string> populationNames();

// Precondition: one of populationNames().
DialDistributions builtInPopulation(std::string_view name);

// The group of heart::heartGroups() from which a built-in population draws dials jointly
// (index_draws.h); none: all its dials are independent.
std::optional<std::size_t> indexGroupOf(std::string_view name);

// The segments of the left ventricle (1 to 17) for a word or a number: lad, rca and lcx by artery;
// anterior, septal, inferior, lateral, apical and all by wall. Empty for an unknown word.
std::vector<int> segmentsOf(std::string_view word);
std::string segmentWords();

}  // namespace echocine::dataset
