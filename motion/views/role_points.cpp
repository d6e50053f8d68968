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

std::vector<Vec3d> without(const std::vector<RoleSurface>& surfaces,
                           std::initializer_list<Role> roles) {
  std::vector<Vec3d> all;
  for (const RoleSurface& s : surfaces)
    if (!isAmong(s.role, roles)) all.insert(all.end(), s.points_m.begin(), s.points_m.end());
  return all;
}

}  // namespace

std::vector<Vec3d> pointsOf(const std::vector<RoleSurface>& surfaces, Role role) {
  std::vector<Vec3d> all;
  for (const RoleSurface& s : surfaces)
    if (s.role == role) all.insert(all.end(), s.points_m.begin(), s.points_m.end());
  return thinned(std::move(all), kMostPoints);
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
  return without(surfaces, {Role::none, Role::surroundings, Role::aorta, Role::aortic_wall,
                            Role::pulmonary_artery, Role::pulmonary_wall});
}

std::vector<Vec3d> frontOf(const std::vector<RoleSurface>& surfaces) {
  return without(surfaces, {Role::none, Role::surroundings, Role::aorta, Role::aortic_wall,
                            Role::pulmonary_artery, Role::pulmonary_wall, Role::la, Role::la_wall,
                            Role::ra, Role::ra_wall});
}

bool hasWall(const std::vector<RoleSurface>& surfaces) {
  return std::any_of(surfaces.begin(), surfaces.end(), [](const RoleSurface& s) {
    return isAmong(s.role, {Role::lv_wall, Role::epicardium, Role::pericardium});
  });
}

}  // namespace echocine
