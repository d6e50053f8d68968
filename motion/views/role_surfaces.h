#pragma once
// The surfaces of structures by role.

#include <string>
#include <vector>

#include "core/vec3.h"
#include "motion/views/facets.h"
#include "scene/role.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// A structure with a role, at one instant.
struct RoleSurface {
  Role role = Role::none;
  std::string name;
  std::vector<Vec3d> points_m;  // vertices, world
  std::vector<Triangle> triangles;
};

// All surfaces with the role, as meshed.
Facets meshedFacetsOf(const std::vector<RoleSurface>& surfaces, Role role);

// The same with no edge over 3 % of its extent (our choice): heights that are
// taken as linear within a facet are then within 0.1 mm.
Facets facetsOf(const std::vector<RoleSurface>& surfaces, Role role);

// "lv (role lv_cavity)": the first structure of a role, for messages; the role alone if there is
// none.
std::string namedRole(const std::vector<RoleSurface>& surfaces, Role role);

// "there are la, ra", each role once.
std::string rolesThere(const std::vector<RoleSurface>& surfaces);

// The heart without the great vessels, as meshed.
Facets outsideOf(const std::vector<RoleSurface>& surfaces);

// The same without the atria: what lies behind the chest beside the sternum.
Facets frontOf(const std::vector<RoleSurface>& surfaces);

// Is there a surface around the left ventricle's muscle?
bool hasWall(const std::vector<RoleSurface>& surfaces);

}  // namespace echocine
