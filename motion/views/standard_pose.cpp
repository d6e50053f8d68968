#include "motion/views/standard_pose.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace echocine {

namespace {

// Half of what counts as in the plane, and as before the probe: half a phased array's face. Our
// choices.
constexpr double kBeam_m = 0.02, kFace_m = 0.01;
constexpr double kBehind_m = 0.0144;  // of the image, behind the heart; our choice
constexpr double kSector_deg = 80;

// Target of a view: the probe stands away from `target`, opposite to `axis`.
struct Aim {
  Vec3d target, axis, lateral;
  double chest_m;  // skin to pericardium; our choice
  bool beside_sternum = false;
};

// Through the apex, looking at a point of the base; the image plane holds the long axis and the
// direction `phi`, which is to the right.
Aim apical(const HeartFrame& heart, double phi_rad, Vec3d base_point) {
  const Vec3d lateral = heart.about(phi_rad);
  const Vec3d axis = normalised(base_point - heart.apex);
  return {heart.apex, axis, normalised(lateral - dot(lateral, axis) * axis), 0.016 * heart.scale};
}

Aim parasternal(const HeartFrame& heart, Vec3d target, Vec3d axis, Vec3d lateral) {
  return {target, axis, lateral, 0.022 * heart.scale, true};
}

// In the valve's plane, which leans: seen from in front and along the ring.
Aim aorticShortAxis(const HeartFrame& heart, Vec3d out, Vec3d across) {
  const Vec3d flow = heart.aortic_flow;
  Aim aim = parasternal(heart, heart.aortic + 0.025 * heart.length_m * flow,
                        normalised(-out - dot(-out, flow) * flow), across);
  aim.lateral = normalised(cross(aim.axis, flow));
  if (dot(aim.lateral, across) < 0) aim.lateral = -aim.lateral;
  return aim;
}

// From under the ribs, up and back and to the left: 10 deg below the four-chamber plane and 20 deg
// towards the base, our choice.
Aim subcostal(const HeartFrame& heart, Vec3d target) {
  const Vec3d from = heart.about(radiansFromDegrees(190));
  const double tilt_rad = radiansFromDegrees(20);
  const Vec3d axis = -std::cos(tilt_rad) * from - std::sin(tilt_rad) * heart.apical;
  return {target, axis, normalised(heart.apical - dot(heart.apical, axis) * axis),
          0.045 * heart.scale};
}

Aim aimOf(View view, const HeartFrame& heart) {
  const double l = heart.length_m;
  // The long axes pass through the aortic valve.
  const double outflow_rad = heart.angleOf(heart.aortic);
  const Vec3d out = heart.about(outflow_rad);
  const Vec3d across = heart.about(outflow_rad - radiansFromDegrees(90));
  switch (view) {
    case View::a4c:
      return apical(heart, 0, heart.at({-0.20 * l, 0, 0}));
    case View::a2c:
      return apical(heart, radiansFromDegrees(60), heart.mitral);
    case View::a3c:
      return apical(heart, outflow_rad, heart.mitral + 0.12 * l * out);
    case View::plax:
      return parasternal(heart, heart.at({0, 0, 0.16 * l}), -out, -heart.apical);
    case View::psax_base:
      return aorticShortAxis(heart, out, across);
    case View::psax_mid:
      return parasternal(heart, heart.at({0, 0, 0.54 * l}) - 0.05 * l * across, -out, across);
    case View::psax_apex:
      return parasternal(heart, heart.at({0, 0, 0.80 * l}) - 0.05 * l * across, -out, across);
    case View::subcostal:
      return subcostal(heart, heart.at({-0.15 * l, 0, 0.22 * l}));
  }
  return {};
}

// How far the points before the target reach towards the probe, in the beam's middle.
double reachBefore(const Aim& aim, std::span<const Vec3d> outside_m, double beam_m) {
  double reach_m = 0;
  for (const Vec3d point : outside_m) {
    const Vec3d from = point - aim.target;
    const double back_m = -dot(from, aim.axis);
    if (length(from + back_m * aim.axis) < beam_m) reach_m = std::max(reach_m, back_m);
  }
  return reach_m;
}

}  // namespace

Vec3d HeartFrame::about(double phi_rad) const {
  return std::cos(phi_rad) * lateral + std::sin(phi_rad) * anterior;
}

double HeartFrame::angleOf(Vec3d place) const {
  return std::atan2(dot(place - origin, anterior), dot(place - origin, lateral));
}

Vec3d HeartFrame::at(Vec3d p) const {
  return origin + p.x * lateral + p.y * anterior + p.z * apical;
}

double fittingDepth(std::span<const Vec3d> outside_m, const ProbePose& pose, double half_rad,
                    double scale) {
  const Vec3d up = cross(pose.axis, pose.lateral);
  double deepest_m = 0;
  for (const Vec3d point : outside_m) {
    const Vec3d from = point - pose.apex;
    const double angle_rad = std::atan2(dot(from, pose.lateral), dot(from, pose.axis));
    if (std::abs(dot(from, up)) < kBeam_m * scale && std::abs(angle_rad) < half_rad)
      deepest_m = std::max(deepest_m, length(from));
  }
  // Continuous, not in steps as on a scanner: similar hearts have similar pictures.
  return deepest_m + kBehind_m * scale;
}

ProbePose standardPose(View view, const HeartFrame& heart, std::span<const Vec3d> outside_m,
                       double wall_m, std::span<const Vec3d> front_m) {
  const Aim aim = aimOf(view, heart);
  const bool front = aim.beside_sternum && !front_m.empty();
  const double to_surface_m =
      reachBefore(aim, front ? front_m : outside_m, kFace_m * heart.scale) + wall_m;
  ProbePose pose{aim.target - (to_surface_m + aim.chest_m) * aim.axis,
                 aim.axis,
                 aim.lateral,
                 0,
                 kSector_deg,
                 aim.chest_m};
  pose.depth_m = fittingDepth(outside_m, pose, radiansFromDegrees(0.5 * kSector_deg), heart.scale);
  return pose;
}

}  // namespace echocine
