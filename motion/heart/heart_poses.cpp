#include "motion/heart/heart_poses.h"

#include "motion/heart/recording.h"
#include "motion/views/heart_marks.h"

namespace echocine::heart {

ProbePose poseOf(View view, const Recording& recording) {
  std::vector<RoleSurface> surfaces;
  for (const RecordedPart& part : recording.parts) {
    const Role role = guessRole(part.kind.name);
    if (role == Role::none || role == Role::surroundings || part.control_m.size() == 1) continue;
    surfaces.push_back({role, part.kind.name, part.control_m.front(), part.faces});
  }
  HeartMarks marks = findHeart(surfaces, {});
  marks.frame.scale = recording.body_scale;
  return standardPose(view, marks.frame, marks.outside_m, marks.wall_m, marks.front_m);
}

}  // namespace echocine::heart
