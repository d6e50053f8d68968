#pragma once
// Anatomical role of a structure, independent of its name.

#include <optional>
#include <string_view>

#include "core/ids.h"

namespace echocine {

struct Scene;
struct Structure;

// Walls are outer surfaces, filled; cavities cut holes into them.
enum class Role {
  none,
  lv_cavity,
  lv_wall,
  rv_cavity,
  rv_wall,
  la,
  la_wall,
  ra,
  ra_wall,
  aorta,
  aortic_wall,
  pulmonary_artery,
  pulmonary_wall,
  mitral_valve,
  aortic_valve,
  tricuspid_valve,
  pulmonary_valve,
  papillary_muscle,
  epicardium,
  pericardium,
  surroundings
};

// Guesses by the words that laboratories use in names: "lv_endo_closed" is lv_cavity, "Left_Atrium"
// la. Role::none if nothing matches.
Role guessRole(std::string_view name);

// The given role, else the guess by name: scenes built in code may omit the role.
Role roleOf(const Structure& structure);

// The first structure of a role.
std::optional<SurfaceId> structureOf(const Scene& scene, Role role);

// Does the picture show the structure's surface with trabeculae? Ventricular cavities have them if
// the scene asks for trabeculae.
bool hasTrabeculae(const Scene& scene, const Structure& structure);

// Thickness of a membrane in the picture, m: near its hinge. 0 for one without thickness, and for
// all but valves.
double leafletThickness(const Scene& scene, const Structure& structure);

// Does the picture show the structure as a body with thickness?
bool hasThickness(const Scene& scene, const Structure& structure);

// Largest displacement of its vertices by trabeculae, m: vertices of the ventricles' walls follow
// those of a cavity at the same place.
double trabeculaeReach(const Scene& scene, const Structure& structure);

}  // namespace echocine
