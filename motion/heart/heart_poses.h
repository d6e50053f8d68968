#pragma once
// Where a probe is held for the standard views of the parametric heart.

#include "motion/heart/heart.h"
#include "motion/views/standard_pose.h"
#include "scene/view_names.h"

namespace echocine::heart {

using echocine::ProbePose, echocine::View, echocine::ViewName;
using echocine::viewNames, echocine::viewOf;

// Its own axes as the views' rules take them: heart coordinates, m.
HeartFrame frameOf(const ParametricHeart& heart);

// Aimed by the heart at end-diastole, over which the probe stays where it is. Heart coordinates.
ProbePose poseOf(View view, const ParametricHeart& heart);
// The same for who has the heart at end-diastole.
ProbePose poseOf(View view, const ParametricHeart& heart, const Shape& at_end_diastole);

}  // namespace echocine::heart
