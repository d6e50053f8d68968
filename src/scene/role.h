#pragma once
// What a structure is in the heart, whatever it is called.

#include <optional>
#include <string_view>

#include "core/ids.h"

namespace echocine {

struct Scene;
struct Structure;

// Walls are outer surfaces, filled; cavities pierce them.
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

// By the words that labs put into names: "lv_endo_closed" is lv_cavity, "Left_Atrium" la; none
// where nothing fits.
Role guessRole(std::string_view name);

// That which a structure was given, else by its name: scenes built in code may leave it out.
Role roleOf(const Structure& structure);

// The first structure of a role.
std::optional<SurfaceId> structureOf(const Scene& scene, Role role);

// Does the picture show the structure's surface with trabeculae? Ventricles' cavities have them,
// where the scene asks for some.
bool hasTrabeculae(const Scene& scene, const Structure& structure);

// How far its vertices may be moved for them: those of the ventricles' walls go along where they
// lie on a cavity's. m.
double trabeculaeReach(const Scene& scene, const Structure& structure);

}  // namespace echocine
