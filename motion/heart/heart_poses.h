#pragma once
// Probe poses of the standard views of the parametric heart.

#include "motion/heart/heart.h"
#include "motion/views/standard_pose.h"
#include "scene/view_names.h"

namespace echocine::heart {

using echocine::ProbePose, echocine::View, echocine::ViewName;
using echocine::viewNames, echocine::viewOf;

// Its axes in the form that the view rules need: heart coordinates, m.
HeartFrame frameOf(const ParametricHeart& heart);

// For the heart at end-diastole; the probe is static over the beat. Heart coordinates.
ProbePose poseOf(View view, const ParametricHeart& heart);
// The same with a given shape at end-diastole.
ProbePose poseOf(View view, const ParametricHeart& heart, const Shape& at_end_diastole);

}  // namespace echocine::heart
