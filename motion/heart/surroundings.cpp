#include "motion/heart/surroundings.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "motion/heart/envelope.h"
#include "motion/heart/heart_units.h"
#include "motion/heart/smooth.h"
#include "motion/heart/tube.h"

// Positions and thicknesses are our choice: an adult's chest in outline, not a patient's.

namespace echocine::heart {
namespace {

Part closedPart(const char* name, const char* medium, int priority, std::vector<Vec3d> points,
                const SphereMesh& sphere) {
  return {{name, medium, priority, false}, std::move(points), sphere.faces};
}

std::vector<Vec3d> ellipsoid(const SphereMesh& sphere, Vec3d centre, Vec3d semi_axes) {
  return pointsOn(sphere, [=](Vec3d d) {
    return centre + Vec3d{semi_axes.x * d.x, semi_axes.y * d.y, semi_axes.z * d.z};
  });
}

struct WallLayer {
  const char *name, *medium;
  int priority;
  double radius_m;  // from the probe's apex to its far side
};

// Shells around the probe: circles in the imaging plane, so that they refract no ray there, and
// long across it, so that they cover the whole lens.
void addShells(const ProbePose& pose, double scale, std::initializer_list<WallLayer> layers,
               std::vector<Part>& parts) {
  static const SphereMesh& kShell = geodesicSphere(20);  // fat is a lens: fine
  const Vec3d elevation = cross(pose.axis, pose.lateral);
  for (const WallLayer& layer : layers) {
    const double across_m = layer.radius_m + 0.02 * scale;
    parts.push_back(closedPart(
        layer.name, layer.medium, layer.priority,
        pointsOn(kShell,
                 [&](Vec3d d) {
                   return pose.apex + layer.radius_m * (d.x * pose.lateral + d.z * pose.axis) +
                          across_m * d.y * elevation;
                 }),
        kShell));
  }
}

// Skin and fat, then muscle.
void addChestWall(const ProbePose& pose, double scale, std::vector<Part>& parts) {
  addShells(pose, scale,
            {{"chest_fat", "fat", 9, std::min(0.007 * scale, 0.4 * pose.chest_m)},
             {"chest_muscle", "muscle", 8, std::min(0.013 * scale, 0.8 * pose.chest_m)}},
            parts);
}

// The wall of the oesophagus round a transoesophageal probe: 3 mm of muscle.
void addOesophagus(const ProbePose& pose, double scale, std::vector<Part>& parts) {
  addShells(pose, scale, {{"oesophagus", "muscle", 8, std::min(0.003 * scale, 0.6 * pose.chest_m)}},
            parts);
}

// In front of the liver, where a probe is pressed in.
void addAbdominalWall(const ProbePose& pose, double scale, std::vector<Part>& parts) {
  addShells(pose, scale,
            {{"abdominal_fat", "fat", 14, 0.008 * scale},
             {"abdominal_muscle", "muscle", 13, 0.015 * scale}},
            parts);
}

// The tissue between the lungs: around the heart, and open towards the probe, where the lungs yield
// to it.
void addMediastinum(const ProbePose& pose, const ParametricHeart& heart,
                    const std::vector<double>& reach_m, double window_rad,
                    std::vector<Part>& parts) {
  static const SphereMesh& kAround = geodesicSphere(Envelope::kFrequency);
  const Vec3d centre = heart.centre();
  const double scale = heart.parameters().body_scale;
  const Vec3d to_probe = pose.apex - centre;
  const double probe_m = length(to_probe) + 0.03 * scale;
  std::vector<Vec3d> points;
  for (std::size_t i = 0; i < reach_m.size(); ++i) {
    const double angle_rad =
        std::acos(std::clamp(dot(kAround.directions[i], normalised(to_probe)), -1.0, 1.0));
    const double open = 1 - smoothStep(0.5 * window_rad, window_rad, angle_rad);
    const double around_m = reach_m[i] + 0.0045 * scale;
    points.push_back(centre + std::lerp(around_m, std::max(probe_m, around_m), open) *
                                  kAround.directions[i]);
  }
  parts.push_back(closedPart("mediastinum", "mediastinum", 6, std::move(points), kAround));
}

// The pleura is smooth: its echo is bright where it faces the probe, and hardly visible along the
// beam. Our choice: 19 dB less at 55 degrees, where a rough surface returns 5 dB less.
constexpr double kPleuraExponent = 8;

void addLungs(const ParametricHeart& heart, std::vector<Part>& parts) {
  static const SphereMesh& kLung = geodesicSphere(6);
  const double l = heart.lvLength();
  const auto add = [&](const char* name, Vec3d centre, Vec3d semi_axes) {
    Part lung = closedPart(name, "lung", 2, ellipsoid(kLung, l * centre, l * semi_axes), kLung);
    lung.kind.reflection_exponent = kPleuraExponent;
    parts.push_back(std::move(lung));
  };
  add("lung_left", {1.35, -0.25, 0.1}, {1.25, 1.9, 2.2});
  add("lung_right", {-2.05, -0.1, -0.1}, {1.25, 1.6, 2.2});
}

// Behind the left atrium, along the spine: from head to foot, perpendicular to the view's long
// axis.
void addDescendingAorta(const ParametricHeart& heart, std::vector<Part>& parts) {
  static const SphereMesh& kVessel = geodesicSphere(7);
  const double l = heart.lvLength(), scale = heart.parameters().body_scale;
  const Vec3d behind = l * Vec3d{0.28, -0.49, -0.28}, along = l * Vec3d{0.62, 0.42, 0.10};
  const double radius_m = 0.011 * scale;
  const Tube tube({{behind - along, radius_m}, {behind, radius_m}, {behind + along, radius_m}});
  const auto add = [&](const char* name, const char* medium, int priority, double wall_m) {
    parts.push_back(closedPart(name, medium, priority,
                               pointsOn(kVessel, [&](Vec3d d) { return tube.point(d, wall_m); }),
                               kVessel));
  };
  add("descending_aorta", "blood", 16, 0);
  add("descending_aortic_wall", "vessel_wall", 14, 0.0018 * scale);
  add("descending_aortic_sheath", "soft_tissue", 7, 0.009 * scale);
}

// Under the heart, which rests on the diaphragm.
void addAbdomen(const ParametricHeart& heart, std::vector<Part>& parts) {
  static const SphereMesh& kLobe = geodesicSphere(8);
  const double l = heart.lvLength(), dome_m = 0.003 * heart.parameters().body_scale;
  const Vec3d centre = l * Vec3d{-0.75, -1.80, 0.35}, semi_axes = l * Vec3d{1.5, 1.25, 1.6};
  const auto add = [&](const char* name, const char* medium, int priority, double grow_m) {
    const Vec3d grown = semi_axes + Vec3d{grow_m, grow_m, grow_m};
    parts.push_back(closedPart(name, medium, priority, ellipsoid(kLobe, centre, grown), kLobe));
  };
  add("abdomen", "liver", 5, 0);
  add("diaphragm", "muscle", 4, dome_m);
}

// Below the diaphragm, between the probe and the heart.
void addLiver(const ProbePose& pose, const ParametricHeart& heart, std::vector<Part>& parts) {
  static const SphereMesh& kLiver = geodesicSphere(8);
  const double scale = heart.parameters().body_scale;
  const Vec3d to_heart = pose.axis;
  // A flattened ball whose far side, the diaphragm, lies just in front of the sac.
  const double half_m = 0.5 * (pose.chest_m + 0.02 * scale), wide_m = 0.11 * scale;
  const Vec3d centre = pose.apex + (pose.chest_m - 0.004 * scale - half_m) * to_heart;
  const Vec3d across = pose.lateral, up = cross(to_heart, across);
  const auto lobe = [&](double grow_m) {
    return pointsOn(kLiver, [&, grow_m](Vec3d d) {
      return centre + (wide_m + grow_m) * d.x * across + (wide_m + grow_m) * d.y * up +
             (half_m + grow_m) * d.z * to_heart;
    });
  };
  parts.push_back(closedPart("liver", "liver", 12, lobe(0), kLiver));
  parts.push_back(closedPart("diaphragm", "muscle", 10, lobe(0.003 * scale), kLiver));
}

}  // namespace

std::vector<Part> surroundingsOf(View view, const ProbePose& pose, const ParametricHeart& heart,
                                 const std::vector<double>& sac_reach_m) {
  std::vector<Part> parts;
  const bool from_below = view == View::subcostal;
  if (from_below) {
    addAbdominalWall(pose, heart.parameters().body_scale, parts);
    addLiver(pose, heart, parts);
  } else {
    (isTransoesophageal(view) ? addOesophagus : addChestWall)(pose, heart.parameters().body_scale,
                                                              parts);
    addAbdomen(heart, parts);
  }
  // Not in apical views.
  if (view == View::plax || view == View::psax_base || view == View::psax_mid)
    addDescendingAorta(heart, parts);
  addMediastinum(pose, heart, sac_reach_m, (from_below ? 80 : 60) * kDegree, parts);
  addLungs(heart, parts);
  return parts;
}

}  // namespace echocine::heart
