#pragma once
// How a drawn heart is imaged: its scene with the drawn values, the probe moved off the standard
// view.

#include "dataset/draws.h"
#include "motion/heart/recording.h"

namespace echocine::dataset {

// The heart of drawn dials. Throws SceneError where they are impossible together.
heart::ParametricHeart modelOf(const Values& values);

// Surrounds a recorded heart as it is where a draw holds the probe: chest wall and lungs give way
// to it there.
void surroundProbe(const Spec& spec, const Draw& draw, std::size_t view,
                   const heart::ParametricHeart& model, heart::Recording& recording);

// The scene of a view of a user's heart, ready to simulate. Precondition: the spec has scenes.
// Throws SceneError where values contradict each other.
Scene sceneOf(const Spec& spec, const Draw& draw, std::size_t view);

// The scene of a view of a recorded heart, ready to simulate. Throws SceneError where values
// contradict each other.
Scene sceneOf(const Spec& spec, const Draw& draw, std::size_t view,
              const heart::Parameters& parameters, const heart::Recording& recording);

}  // namespace echocine::dataset
