#pragma once
// Real hearts (published meshes, beside the project) with their valves as a hand would mark them.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "core/hash.h"
#include "motion/mesh/mesh_io.h"
#include "motion/views/heart_marks.h"
#include "scene/names.h"
#include "support/paths.h"

namespace echocine::support {

struct RealHeart {
  std::string name;
  std::vector<RoleSurface> surfaces;  // m
  std::vector<std::vector<Triangle>> triangles;
  Vec3d apex, mitral, tricuspid, aortic;
  bool has_aorta = false;  // or its valve

  bool has(Role role) const {
    return std::any_of(surfaces.begin(), surfaces.end(),
                       [&](const RoleSurface& s) { return s.role == role; });
  }
  const std::vector<Vec3d>& points(Role role) const {
    return std::find_if(surfaces.begin(), surfaces.end(),
                        [&](const RoleSurface& s) { return s.role == role; })
        ->points_m;
  }
  void add(Role role, const std::filesystem::path& file, double metres_per_unit) {
    Sha256 digest;
    const TriangleMesh mesh = readMesh(file, digest);
    RoleSurface surface{role, file.stem().string(), {}, mesh.triangles};
    for (const Vec3d p : mesh.positions) surface.points_m.push_back(metres_per_unit * p);
    surfaces.push_back(surface);
    triangles.push_back(mesh.triangles);
  }
};

inline std::filesystem::path realFolder() {
  return std::filesystem::path(kSharedDir) / "real";
}
inline bool realHeartsThere() {
  return std::filesystem::is_directory(realFolder() / "statics/heartdeform_whole_heart");
}

inline double angleBetween_deg(Vec3d a, Vec3d b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

inline Vec3d meanPoint(const std::vector<Vec3d>& points) {
  Vec3d sum{};
  for (const Vec3d p : points) sum = sum + p;
  return 1 / static_cast<double>(points.size()) * sum;
}

// Those points of either surface that lie near the other: the rim of a valve between two chambers.
inline Vec3d rimBetween(const RealHeart& heart, Role a, Role b, double apart_m) {
  std::vector<Vec3d> rim;
  const auto collect = [&](const std::vector<Vec3d>& from, const std::vector<Vec3d>& to) {
    for (const Vec3d p : from)
      if (std::any_of(to.begin(), to.end(), [&](Vec3d q) { return length(q - p) < apart_m; }))
        rim.push_back(p);
  };
  collect(heart.points(a), heart.points(b));
  collect(heart.points(b), heart.points(a));
  return meanPoint(rim);
}

inline Vec3d farthestFrom(Vec3d place, const std::vector<Vec3d>& points) {
  return *std::max_element(points.begin(), points.end(),
                           [&](Vec3d a, Vec3d b) { return length(a - place) < length(b - place); });
}

// Ventricles and valve planes of a folder's first frame.
inline RealHeart ventriclesIn(const std::filesystem::path& folder, const std::string& name,
                              double metres_per_unit) {
  RealHeart heart{name, {}, {}, {}, {}, {}, {}, true};
  const auto add = [&](Role role, const std::string& part) {
    heart.add(role, folder / (part + "_000.obj"), metres_per_unit);
  };
  add(Role::lv_cavity, "lv_endo_closed");
  add(Role::rv_cavity, "rv_endo_closed");
  add(Role::lv_wall, "epi");
  add(Role::mitral_valve, "mitral_valve");
  add(Role::aortic_valve, "aortic_valve");
  add(Role::tricuspid_valve, "tricuspid_valve");
  add(Role::pulmonary_valve, "pulmonary_valve");
  heart.mitral = meanPoint(heart.points(Role::mitral_valve));
  heart.tricuspid = meanPoint(heart.points(Role::tricuspid_valve));
  heart.aortic = meanPoint(heart.points(Role::aortic_valve));
  heart.apex = farthestFrom(heart.mitral, heart.points(Role::lv_cavity));
  return heart;
}

// One patient's ventricles and valve planes at end-diastole.
inline RealHeart patientHeart() {
  return ventriclesIn(realFolder() / "meshes/bivme_patient1_25f", "patient", 1e-3);
}

// Seven chambers and vessels segmented from CT; its unit cube at a size that a heart has.
inline RealHeart wholeHeart() {
  RealHeart heart{"whole heart", {}, {}, {}, {}, {}, {}, true};
  const Role roles[] = {Role::lv_wall,   Role::la,    Role::lv_cavity,       Role::ra,
                        Role::rv_cavity, Role::aorta, Role::pulmonary_artery};
  for (int region = 1; region <= 7; ++region)
    heart.add(roles[region - 1],
              realFolder() / "statics/heartdeform_whole_heart" /
                  ("region_" + std::to_string(region) + ".obj"),
              0.28);
  heart.mitral = rimBetween(heart, Role::la, Role::lv_cavity, 4e-3);
  heart.tricuspid = rimBetween(heart, Role::ra, Role::rv_cavity, 4e-3);
  heart.aortic = rimBetween(heart, Role::aorta, Role::lv_cavity, 4e-3);
  heart.apex = farthestFrom(heart.mitral, heart.points(Role::lv_cavity));
  return heart;
}

// Four chambers of another heart, the left ventricle with its muscle.
inline RealHeart fourChamberHeart() {
  RealHeart heart{"four-chamber heart", {}, {}, {}, {}, {}, {}, false};
  const auto file = [](const std::string& name) {
    return realFolder() / "statics/ghdheart_4ch" / (name + ".obj");
  };
  heart.add(Role::lv_cavity, file("LV"), 0.1);
  heart.add(Role::rv_cavity, file("RV"), 0.1);
  heart.add(Role::la, file("LA"), 0.1);
  heart.add(Role::ra, file("RA"), 0.1);
  heart.mitral = rimBetween(heart, Role::la, Role::lv_cavity, 4e-3);
  heart.tricuspid = rimBetween(heart, Role::ra, Role::rv_cavity, 4e-3);
  heart.apex = farthestFrom(heart.mitral, heart.points(Role::lv_cavity));
  return heart;
}

// How much of a structure's outline the sector shows, m.
inline double cutLength_m(const RealHeart& heart, Role role, const ProbePose& pose) {
  const Pose frame{pose.apex, pose.lateral, cross(pose.axis, pose.lateral), pose.axis};
  const double half_rad = 0.5 * pose.sector_deg * std::numbers::pi / 180;
  double sum_m = 0;
  for (std::size_t s = 0; s < heart.surfaces.size(); ++s) {
    if (heart.surfaces[s].role != role) continue;
    for (const Triangle& t : heart.triangles[s]) {
      std::vector<Vec3d> ends;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d a = frame.fromWorld(heart.surfaces[s].points_m[t[k]]),
                    b = frame.fromWorld(heart.surfaces[s].points_m[t[(k + 1) % 3]]);
        if ((a.y < 0) != (b.y < 0)) ends.push_back(a + a.y / (a.y - b.y) * (b - a));
      }
      if (ends.size() != 2) continue;
      const Vec3d middle = 0.5 * (ends[0] + ends[1]);
      if (std::abs(std::atan2(middle.x, middle.z)) < half_rad && length(middle) < pose.depth_m)
        sum_m += length(ends[1] - ends[0]);
    }
  }
  return sum_m;
}

}  // namespace echocine::support
