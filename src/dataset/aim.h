#pragma once
// How a drawn heart is imaged: its scene with the drawn values, the probe moved off the standard
// view.

#include "dataset/draws.h"
#include "motion/heart/recording.h"

namespace echocine::dataset {

// The dials of a draw.
heart::Parameters parametersOf(const Values& values);

// The scene of a view of a recorded heart, ready to simulate. Throws SceneError where values
// contradict each other.
Scene sceneOf(const Spec& spec, const Draw& draw, std::size_t view,
              const heart::Parameters& parameters, const heart::Recording& recording);

}  // namespace echocine::dataset
