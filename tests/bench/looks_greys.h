#pragma once
// Grey statistics of simulated hearts in eight views: black, white, and the medians of regions.

#include "looks_scene.h"

namespace echocine::bench {

// Prints a row per view, at end-diastole and end-systole: medians over the hearts.
void printGreys(const LookHearts& options);

}  // namespace echocine::bench
