#pragma once
// The vertices of structures by role.

#include <string>
#include <vector>

#include "core/vec3.h"
#include "scene/role.h"

namespace echocine {

// A structure with a role, at one instant.
struct RoleSurface {
  Role role = Role::none;
  std::string name;
  std::vector<Vec3d> points_m;  // vertices, world
};

// Points of all surfaces with the role, thinned: enough for a millimetre, few enough for all
// pairwise distances.
std::vector<Vec3d> pointsOf(const std::vector<RoleSurface>& surfaces, Role role);

// "lv (role lv_cavity)": the first structure of a role, for messages; the role alone if there is
// none.
std::string namedRole(const std::vector<RoleSurface>& surfaces, Role role);

// "there are la, ra", each role once.
std::string rolesThere(const std::vector<RoleSurface>& surfaces);

// All vertices of the heart without the great vessels.
std::vector<Vec3d> outsideOf(const std::vector<RoleSurface>& surfaces);

// The same without the atria: what lies behind the chest beside the sternum.
std::vector<Vec3d> frontOf(const std::vector<RoleSurface>& surfaces);

// Is there a surface around the left ventricle's muscle?
bool hasWall(const std::vector<RoleSurface>& surfaces);

}  // namespace echocine
