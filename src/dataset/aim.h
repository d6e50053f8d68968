#pragma once
// Imaging of a drawn heart: its scene with the drawn values, the probe displaced from the standard
// view.

#include "dataset/draws.h"
#include "motion/heart/recording.h"

namespace echocine::dataset {

// The heart of drawn dials. A value of the spec replaces that of a population in its segments; of
// two values for a segment, that of the smaller group counts. Throws SceneError for an impossible
// combination.
heart::ParametricHeart modelOf(const Spec& spec, const Values& values);

// Adds the surroundings of a recorded heart for the drawn probe pose: chest wall and lungs yield to
// the probe there.
void surroundProbe(const Spec& spec, const Draw& draw, std::size_t view,
                   const heart::ParametricHeart& model, heart::Recording& recording);

// The scene of a view of a user's heart, ready to simulate. Precondition: the spec has scenes.
// Throws SceneError for contradictory values.
Scene sceneOf(const Spec& spec, const Draw& draw, std::size_t view);

// The scene of a view of a recorded heart, ready to simulate. Throws SceneError for contradictory
// values.
Scene sceneOf(const Spec& spec, const Draw& draw, std::size_t view,
              const heart::Parameters& parameters, const heart::Recording& recording);

}  // namespace echocine::dataset
