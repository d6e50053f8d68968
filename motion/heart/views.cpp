#include "motion/heart/views.h"

namespace echocine::heart {
namespace {

std::vector<Vec3d> sacOf(const ParametricHeart& heart) {
  for (const Part& part : heart.at(0))
    if (part.kind.name == "pericardium") return part.points;
  return {};
}

}  // namespace

HeartFrame frameOf(const ParametricHeart& heart) {
  const Landmarks marks = heart.landmarksAt(0);
  HeartFrame frame;
  frame.length_m = heart.lvLength();
  frame.scale = heart.parameters().body_scale;
  frame.apex = marks.apex;
  frame.mitral = marks.mitral;
  frame.aortic = marks.aortic;
  frame.aortic_flow = marks.aortic_flow;
  return frame;
}

ProbePose poseOf(View view, const ParametricHeart& heart) {
  return standardPose(view, frameOf(heart), sacOf(heart));
}

}  // namespace echocine::heart
