#include "motion/heart/heart_poses.h"

namespace echocine::heart {
namespace {

HeartFrame heartFrame(const ParametricHeart& heart, const Landmarks& marks) {
  HeartFrame frame;
  frame.length_m = heart.lvLength();
  frame.scale = heart.parameters().body_scale;
  frame.apex = marks.apex;
  frame.mitral = marks.mitral;
  frame.aortic = marks.aortic;
  frame.aortic_flow = marks.aortic_flow;
  return frame;
}

}  // namespace

HeartFrame frameOf(const ParametricHeart& heart) {
  return heartFrame(heart, heart.landmarksAt(0));
}

ProbePose poseOf(View view, const ParametricHeart& heart) {
  return poseOf(view, heart, heart.shapeAt(0));
}

ProbePose poseOf(View view, const ParametricHeart& heart, const Shape& at_end_diastole) {
  std::vector<Vec3d> sac;
  for (const Part& part : at_end_diastole.parts)
    if (part.kind.name == "pericardium") sac = part.points;
  return standardPose(view, heartFrame(heart, at_end_diastole.places), sac);
}

}  // namespace echocine::heart
