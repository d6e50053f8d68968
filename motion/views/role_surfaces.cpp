#include "motion/views/role_surfaces.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/names.h"

namespace echocine {

namespace {

constexpr double kFinest = 0.03;  // edge of a refined surface, of its extent

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
Facets facetsWhere(const std::vector<RoleSurface>& surfaces, Wanted wanted) {
  Facets all;
  for (const RoleSurface& s : surfaces) {
    if (!wanted(s.role)) continue;
    for (const Triangle& t : s.triangles)
      all.push_back({s.points_m[t[0]], s.points_m[t[1]], s.points_m[t[2]]});
  }
  return all;
}

}  // namespace

Facets meshedFacetsOf(const std::vector<RoleSurface>& surfaces, Role role) {
  return facetsWhere(surfaces, [role](Role other) { return other == role; });
}

Facets facetsOf(const std::vector<RoleSurface>& surfaces, Role role) {
  const Facets all = meshedFacetsOf(surfaces, role);
  if (all.empty()) return all;
  const double extent = 2 * farthestFrom(all, middleOf(all));
  return extent > 0 ? refined(all, kFinest * extent) : all;
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

Facets outsideOf(const std::vector<RoleSurface>& surfaces) {
  return facetsWhere(surfaces, isOfHeart);
}

Facets frontOf(const std::vector<RoleSurface>& surfaces) {
  return facetsWhere(surfaces, [](Role role) { return isOfHeart(role) && !isAtrium(role); });
}

bool hasWall(const std::vector<RoleSurface>& surfaces) {
  return std::any_of(surfaces.begin(), surfaces.end(), [](const RoleSurface& s) {
    return isAmong(s.role, {Role::lv_wall, Role::epicardium, Role::pericardium});
  });
}

}  // namespace echocine
