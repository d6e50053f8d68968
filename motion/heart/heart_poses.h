#pragma once
// Probe poses of the standard views of the parametric heart.

#include "motion/heart/heart.h"
#include "motion/views/standard_pose.h"
#include "scene/view_names.h"

namespace echocine::heart {

using echocine::ProbePose, echocine::View, echocine::ViewName;
using echocine::viewNames, echocine::viewOf;

struct Recording;

// The probe of a view of a recorded heart, in heart coordinates: the rules of standardPose() for
// the axes found in the meshes at end-diastole (findHeart()), at the body's scale. A scene of these
// meshes with `view` of a body of scale 1 has the same. The probe is static over the beat.
ProbePose poseOf(View view, const Recording& recording);

}  // namespace echocine::heart
