#pragma once
// Registration of two loops: one beam space, one beat, one time, one place.

#include <vector>

#include "compare/compare.h"

namespace echocine::compare {

// Sets grid, beams, weights, beats, time, space and overlap of `c`, whose loops are read. Space is
// found by SpaceSearch, and each of its starts is paired in time separately. Throws SceneError if
// the loops share too little, or are too long for memory.
void registerLoops(const CompareOptions& options, Comparison& c);

// The synthetic loop at a real frame's instant; frames outside it are unchanged.
std::vector<float> pairedFrame(const Comparison& c, std::size_t real);

// Eq. 2 of frame_discrepancy.h for each frame, with the current registration; 0 if the synthetic
// loop does not show the instant.
std::vector<double> discrepancies(const Comparison& c);

// Mean over real frames with a partner, without repeats; 0 without any.
double meanCounted(const Comparison& c, const std::vector<double>& values);

}  // namespace echocine::compare
