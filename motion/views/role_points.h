#pragma once
// The vertices of structures by their roles.

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

// Of all surfaces with the role, thinned out: enough for a millimetre, few enough for the distances
// of every pair.
std::vector<Vec3d> pointsOf(const std::vector<RoleSurface>& surfaces, Role role);

// "lv (role lv_cavity)", as messages name the first of a role; the role alone where none has it.
std::string namedRole(const std::vector<RoleSurface>& surfaces, Role role);

// "there are la, ra", each role once.
std::string rolesThere(const std::vector<RoleSurface>& surfaces);

// All vertices of what belongs to the heart; the great vessels are left out.
std::vector<Vec3d> outsideOf(const std::vector<RoleSurface>& surfaces);

// Of these what stands behind the chest beside the sternum: without the atria.
std::vector<Vec3d> frontOf(const std::vector<RoleSurface>& surfaces);

// A surface around the left ventricle's muscle is among them.
bool hasWall(const std::vector<RoleSurface>& surfaces);

}  // namespace echocine
