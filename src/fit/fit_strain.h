#pragma once
// Global longitudinal strain of a parametric heart, without its meshes.

#include <vector>

#include "motion/heart/parameters.h"

namespace echocine::fit {

// (17)  GLS(t) = L(t) / L(0) - 1
// L: mean length of 36 meridians in the middle of the left ventricle's wall, from the mitral ring
// to the apex. The middle is that at end-diastole, of muscle that keeps its volume. The truth of a
// render (src/truth) is the mean of local strains, without places beside the valves. For two hearts
// it was -0.172 and -0.100, against -0.184 and -0.105 here. Phases: 0 to 1. Throws SceneError for
// an impossible ventricle.
std::vector<double> longitudinalStrains(const heart::Parameters& parameters,
                                        const std::vector<double>& phases);

// At end-systole.
double longitudinalStrainOf(const heart::Parameters& parameters);

}  // namespace echocine::fit
