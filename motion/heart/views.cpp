#include "motion/heart/views.h"

#include <algorithm>
#include <cmath>

#include "motion/heart/units.h"

namespace echocine::heart {
namespace {

constexpr ViewName kViews[] = {
    {View::a4c, "a4c", "apical four-chamber"},
    {View::a2c, "a2c", "apical two-chamber"},
    {View::a3c, "a3c", "apical long axis (three-chamber)"},
    {View::plax, "plax", "parasternal long axis"},
    {View::psax_base, "psax-base", "parasternal short axis at the aortic valve"},
    {View::psax_mid, "psax-mid", "parasternal short axis at the papillary muscles"},
    {View::psax_apex, "psax-apex", "parasternal short axis near the apex"},
    {View::subcostal, "subcostal", "subcostal four-chamber"},
};

// What a view looks at: the probe stands off `target` against `axis`.
struct Aim {
  Vec3d target, axis, lateral;
  double chest_m;  // skin to pericardium; our choice
};

Vec3d about(double phi_rad) {
  return {std::cos(phi_rad), std::sin(phi_rad), 0};
}

// Through the apex, looking at a point of the base; the image plane holds the long axis and the
// direction `phi`, which is to the right.
Aim apical(const Landmarks& marks, double phi_rad, Vec3d base_point, double scale) {
  const Vec3d lateral = about(phi_rad);
  const Vec3d axis = normalised(base_point - marks.apex);
  return {marks.apex, axis, normalised(lateral - dot(lateral, axis) * axis), 0.016 * scale};
}

Aim parasternal(Vec3d target, Vec3d axis, Vec3d lateral, double scale) {
  return {target, axis, lateral, 0.022 * scale};
}

Aim aimOf(View view, const ParametricHeart& heart, const Landmarks& marks) {
  const double l = heart.lvLength(), scale = heart.parameters().body_scale;
  // The long axes pass through the aortic valve.
  const double outflow_rad = std::atan2(marks.aortic.y, marks.aortic.x);
  const Vec3d out = about(outflow_rad);
  const Vec3d across = about(outflow_rad - 90 * kDegree);
  switch (view) {
    case View::a4c:
      return apical(marks, 0, {-0.20 * l, 0, 0}, scale);
    case View::a2c:
      return apical(marks, 60 * kDegree, marks.mitral, scale);
    case View::a3c:
      return apical(marks, outflow_rad, marks.mitral + 0.12 * l * out, scale);
    case View::plax:
      return parasternal({0, 0, 0.16 * l}, -out, {0, 0, -1}, scale);
    case View::psax_base: {
      // In the valve's plane, which leans: seen from in front and along the ring.
      const Vec3d axis = normalised(-out - dot(-out, marks.aortic_flow) * marks.aortic_flow);
      Aim aim = parasternal({}, axis, across, scale);
      aim.target = marks.aortic + 0.025 * l * marks.aortic_flow;
      aim.lateral = normalised(cross(axis, marks.aortic_flow));
      if (dot(aim.lateral, across) < 0) aim.lateral = -aim.lateral;
      return aim;
    }
    case View::psax_mid:
      return parasternal(Vec3d{0, 0, 0.54 * l} - 0.13 * l * across, -out, across, scale);
    case View::psax_apex:
      return parasternal(Vec3d{0, 0, 0.80 * l} - 0.08 * l * across, -out, across, scale);
    case View::subcostal: {
      const Vec3d from = about(200 * kDegree);
      return {{-0.15 * l, 0, 0.22 * l}, -from, {0, 0, 1}, 0.045 * scale};
    }
  }
  return {};
}

std::vector<Vec3d> sacOf(const ParametricHeart& heart) {
  for (const Part& part : heart.at(0))
    if (part.kind.name == "pericardium") return part.points;
  return {};
}

}  // namespace

std::span<const ViewName> viewNames() {
  return kViews;
}

std::optional<View> viewOf(std::string_view key) {
  for (const ViewName& name : kViews)
    if (key == name.key) return name.view;
  return std::nullopt;
}

ProbePose poseOf(View view, const ParametricHeart& heart) {
  const Aim aim = aimOf(view, heart, heart.landmarksAt(0));
  const std::vector<Vec3d> sac = sacOf(heart);
  const double scale = heart.parameters().body_scale;
  // Skin: the chest's thickness before the sac, where the beam's middle enters it.
  const double beam_m = 0.02 * scale;
  double to_sac_m = 0;
  for (const Vec3d point : sac) {
    const Vec3d from = point - aim.target;
    const double back_m = -dot(from, aim.axis);
    if (length(from + back_m * aim.axis) < beam_m) to_sac_m = std::max(to_sac_m, back_m);
  }
  ProbePose pose{
      aim.target - (to_sac_m + aim.chest_m) * aim.axis, aim.axis, aim.lateral, 0, 80, aim.chest_m};
  // Deep enough for all of the heart in the image.
  const Vec3d up = cross(aim.axis, aim.lateral);
  const double half_rad = 0.5 * pose.sector_deg * kDegree;
  double deepest_m = 0;
  for (const Vec3d point : sac) {
    const Vec3d from = point - pose.apex;
    const double angle_rad = std::atan2(dot(from, aim.lateral), dot(from, aim.axis));
    if (std::abs(dot(from, up)) < beam_m && std::abs(angle_rad) < half_rad)
      deepest_m = std::max(deepest_m, length(from));
  }
  // Not in steps, as a scanner's: hearts that are nearly alike have pictures that are.
  constexpr double kBehind_m = 0.0144;  // our choice
  pose.depth_m = deepest_m + kBehind_m * scale;
  return pose;
}

}  // namespace echocine::heart
