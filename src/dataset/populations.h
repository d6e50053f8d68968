#pragma once
// Named populations of hearts: what the dials of each are drawn from, with sources.

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/distribution.h"

namespace echocine::dataset {

// By parameter, such as "ef" or "segments.lad.amplitude".
using DialDistributions = std::map<std::string, Distribution>;

// The names of those built in, in the order that messages have.
std::vector<std::string> populationNames();

// Precondition: one of populationNames().
DialDistributions builtInPopulation(std::string_view name);

// The segments of the left ventricle (1 to 17) that a word or a number stands for: lad, rca and lcx
// by the arteries, anterior, septal, inferior, lateral, apical and all by the wall. Empty: no such
// word.
std::vector<int> segmentsOf(std::string_view word);
std::string segmentWords();

}  // namespace echocine::dataset
