#pragma once
// Two loops laid on one another: one beam space, one beat, one time, one place.

#include <vector>

#include "compare/compare.h"

namespace echocine::compare {

// Fills grid, beams, weights, beats, time, space and overlap of `c`, whose loops are read.
// Space by SpaceSearch, whose every start is paired in time for itself.
// Throws SceneError when they share too little, or are too long for memory.
void registerLoops(const CompareOptions& options, Comparison& c);

// The synthetic loop at a real frame's instant; frames outside it are left as they are.
std::vector<float> pairedFrame(const Comparison& c, std::size_t real);

// Eq. 2 of discrepancy.h frame by frame, as the loops lie now; 0 where the synthetic one shows no
// such instant.
std::vector<double> discrepancies(const Comparison& c);

// Over real frames that have a partner and repeat no other; 0 without any.
double meanCounted(const Comparison& c, const std::vector<double>& values);

}  // namespace echocine::compare
