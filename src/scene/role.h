#pragma once
// What a structure is in the heart, whatever it is called.

#include <string_view>

namespace echocine {

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

}  // namespace echocine
