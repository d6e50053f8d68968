#include "motion/views/role_points.h"

#include <fmt/format.h>

#include <algorithm>

#include "motion/views/point_cloud.h"
#include "scene/names.h"

namespace echocine {

namespace {

constexpr std::size_t kMostPoints = 2000;

bool isAmong(Role role, std::initializer_list<Role> roles) {
  return std::find(roles.begin(), roles.end(), role) != roles.end();
}

bool isOfHeart(Role role) {
  return !isAmong(role, {Role::none, Role::surroundings, Role::aorta, Role::aortic_wall,
                         Role::pulmonary_artery, Role::pulmonary_wall});
}

bool isAtrium(Role role) {
  return isAmong(role, {Role::la, Role::la_wall, Role::ra, Role::ra_wall});
}

template <typename Wanted>
std::vector<Vec3d> pointsWhere(const std::vector<RoleSurface>& surfaces, Wanted wanted) {
  std::vector<Vec3d> all;
  for (const RoleSurface& s : surfaces)
    if (wanted(s.role)) all.insert(all.end(), s.points_m.begin(), s.points_m.end());
  return all;
}

}  // namespace

std::vector<Vec3d> pointsOf(const std::vector<RoleSurface>& surfaces, Role role) {
  return thinned(pointsWhere(surfaces, [role](Role other) { return other == role; }), kMostPoints);
}

std::string namedRole(const std::vector<RoleSurface>& surfaces, Role role) {
  for (const RoleSurface& s : surfaces)
    if (s.role == role) return fmt::format("{} (role {})", s.name, nameOf(role));
  return nameOf(role);
}

std::string rolesThere(const std::vector<RoleSurface>& surfaces) {
  std::string roles;
  for (const RoleSurface& s : surfaces) {
    const std::string role = nameOf(s.role);
    if (s.role == Role::none || (", " + roles + ",").find(", " + role + ",") != std::string::npos)
      continue;
    roles += (roles.empty() ? "" : ", ") + role;
  }
  return roles.empty() ? "no structure has one" : "there are " + roles;
}

std::vector<Vec3d> outsideOf(const std::vector<RoleSurface>& surfaces) {
  return pointsWhere(surfaces, isOfHeart);
}

std::vector<Vec3d> frontOf(const std::vector<RoleSurface>& surfaces) {
  return pointsWhere(surfaces, [](Role role) { return isOfHeart(role) && !isAtrium(role); });
}

bool hasWall(const std::vector<RoleSurface>& surfaces) {
  return std::any_of(surfaces.begin(), surfaces.end(), [](const RoleSurface& s) {
    return isAmong(s.role, {Role::lv_wall, Role::epicardium, Role::pericardium});
  });
}

}  // namespace echocine
