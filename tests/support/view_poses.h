#pragma once
// Poses that views find in a heart's surfaces, and how near two poses are.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "motion/views/heart_marks.h"
#include "support/real_hearts.h"

namespace echocine::support {

inline HeartMarks marksIn(const std::vector<RoleSurface>& surfaces) {
  return findHeart(surfaces, {});
}
inline ProbePose poseIn(View view, const HeartMarks& marks) {
  return standardPose(view, marks.frame, marks.outside_m, marks.wall_m, marks.front_m);
}
inline ProbePose poseIn(View view, const std::vector<RoleSurface>& surfaces) {
  return poseIn(view, marksIn(surfaces));
}

inline void expectNear(const ProbePose& pose, const ProbePose& wanted, double most_deg,
                       double most_mm, const std::string& what) {
  EXPECT_LT(angleBetween_deg(pose.axis, wanted.axis), most_deg) << what << ", axis";
  EXPECT_LT(angleBetween_deg(pose.lateral, wanted.lateral), most_deg) << what << ", lateral";
  EXPECT_LT(1e3 * length(pose.apex - wanted.apex), most_mm) << what << ", place";
}

}  // namespace echocine::support
