#include "motion/views/standard_pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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
  double least_m = 0;  // from the target to the surface before it
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

// From the oesophagus behind the left atrium, through the plane of the apical four-chamber view, to
// the apex: mid-oesophageal, 0 degrees (Hahn, J. Am. Soc. Echocardiogr. 26, 2013). A wall of 3 mm
// and tissue of 2 mm lie before the atrium. Half the ventricle's length stands for an atrium that
// the meshes lack. Our choices.
Aim transoesophageal(const HeartFrame& heart, Vec3d base_point) {
  Aim aim = apical(heart, 0, base_point);
  return {base_point,          -aim.axis, aim.lateral,
          0.005 * heart.scale, false,     heart.has_left_atrium ? 0 : 0.5 * heart.length_m};
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
    case View::tee_4c:
      return transoesophageal(heart, heart.at({-0.20 * l, 0, 0}));
  }
  return {};
}

// Largest height of a facet within `radius` of the z axis. Heights are linear, so it is at a
// corner, where an edge or the facet itself leaves the cylinder.
double highestWithin(const Facet& f, double radius, double least) {
  const auto inside = [&](Vec3d p) { return p.x * p.x + p.y * p.y <= radius * radius; };
  double most = least;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d a = f[k], along = f[(k + 1) % 3] - a;
    if (inside(a)) most = std::max(most, a.z);
    const double square = along.x * along.x + along.y * along.y;
    const double half = a.x * along.x + a.y * along.y;
    const double under = half * half - square * (a.x * a.x + a.y * a.y - radius * radius);
    if (!(square > 0 && under >= 0)) continue;
    for (const double root : {-std::sqrt(under), std::sqrt(under)})
      if (const double t = (root - half) / square; t >= 0 && t <= 1)
        most = std::max(most, a.z + t * along.z);
  }
  // The steepest way up: where it leaves the cylinder within the facet.
  const Vec3d normal = cross(f[1] - f[0], f[2] - f[0]);
  const double steep = std::hypot(normal.x, normal.y);
  if (!(std::abs(normal.z) > 0 && steep > 0)) return most;
  const double way = -radius * (normal.z > 0 ? 1 : -1) / steep;
  Vec3d at{way * normal.x, way * normal.y, 0};
  at.z = f[0].z - ((at.x - f[0].x) * normal.x + (at.y - f[0].y) * normal.y) / normal.z;
  for (std::size_t k = 0; k < 3; ++k)
    if (!(dot(cross(f[(k + 1) % 3] - f[k], at - f[k]), normal) >= 0)) return most;
  return std::max(most, at.z);
}

// How far the surface before the target reaches towards the probe, in the beam's middle.
double reachBefore(const Aim& aim, std::span<const Facet> outside_m, double beam_m) {
  const Vec3d up = cross(aim.axis, aim.lateral);
  const auto seen = [&](Vec3d p) {
    const Vec3d from = p - aim.target;
    return Vec3d{dot(from, aim.lateral), dot(from, up), -dot(from, aim.axis)};
  };
  double reach_m = 0;
  for (const Facet& f : outside_m)
    reach_m = highestWithin({seen(f[0]), seen(f[1]), seen(f[2])}, beam_m, reach_m);
  return reach_m;
}

// The part within the beam's thickness.
Facets inBeam(std::span<const Facet> outside_m, const ProbePose& pose, double scale) {
  const Vec3d up = cross(pose.axis, pose.lateral);
  Facets shown{outside_m.begin(), outside_m.end()};
  for (const double side : {1.0, -1.0})
    shown = partAbove(
        shown, [&](Vec3d p) { return side * dot(p - pose.apex, up); }, -kBeam_m * scale);
  return shown;
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

StandardPlane standardPlane(View view, const HeartFrame& heart) {
  const Aim aim = aimOf(view, heart);
  StandardPlane plane{normalised(cross(aim.axis, aim.lateral)), aim.axis, aim.target};
  plane.short_axis = view == View::psax_base || view == View::psax_mid || view == View::psax_apex;
  if (plane.short_axis) return plane;
  const Vec3d middle = 0.5 * (heart.origin + heart.apex);
  plane.centre = middle - dot(middle - aim.target, plane.normal) * plane.normal;
  return plane;
}

// A distance is largest at a corner of what the image holds of a facet.
double fittingDepth(std::span<const Facet> outside_m, const ProbePose& pose, double half_rad,
                    double scale) {
  const double sine = std::sin(half_rad), cosine = std::cos(half_rad);
  Facets shown = inBeam(outside_m, pose, scale);
  const auto beside = [&](double side) {
    shown = partAbove(
        shown,
        [&](Vec3d p) {
          return sine * dot(p - pose.apex, pose.axis) +
                 side * cosine * dot(p - pose.apex, pose.lateral);
        },
        0);
  };
  if (half_rad < std::numbers::pi) {
    beside(-1);
    beside(1);
  }
  // Continuous, not in steps as on a scanner: similar hearts have similar pictures.
  return farthestFrom(shown, pose.apex) + kBehind_m * scale;
}

double fittingDepth(std::span<const Facet> outside_m, const ProbePose& pose, double first_m,
                    double last_m, double scale) {
  Facets shown = inBeam(outside_m, pose, scale);
  const auto aside = [&](Vec3d p) { return dot(p - pose.apex, pose.lateral); };
  shown = partAbove(shown, aside, first_m);
  shown = partAbove(
      shown, [&](Vec3d p) { return -aside(p); }, -last_m);
  double deepest_m = 0;
  for (const Facet& facet : shown)
    for (const Vec3d p : facet) deepest_m = std::max(deepest_m, dot(p - pose.apex, pose.axis));
  return deepest_m + kBehind_m * scale;
}

ProbePose standardPose(View view, const HeartFrame& heart, std::span<const Facet> outside_m,
                       double wall_m, std::span<const Facet> front_m) {
  const Aim aim = aimOf(view, heart);
  const bool front = aim.beside_sternum && !front_m.empty();
  const double to_surface_m = std::max(
      aim.least_m, reachBefore(aim, front ? front_m : outside_m, kFace_m * heart.scale) + wall_m);
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
