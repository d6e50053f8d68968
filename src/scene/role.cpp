#include "scene/role.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string>

#include "scene/scene.h"

namespace echocine {

namespace {

// The name in lower case, its words between single underscores: "_left_atrium_".
std::string wordsOf(std::string_view name) {
  std::string words = "_";
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) != 0)
      words += static_cast<char>(std::tolower(u));
    else if (words.back() != '_')
      words += '_';
  }
  return words + "_";
}

bool has(const std::string& words, std::initializer_list<const char*> any) {
  return std::any_of(any.begin(), any.end(),
                     [&](const char* word) { return words.find(word) != std::string::npos; });
}

// A chamber's own name alone is its cavity.
Role chamber(const std::string& words, Role cavity, Role wall) {
  return has(words, {"wall", "myo", "epi", "muscle"}) ? wall : cavity;
}

}  // namespace

Role guessRole(std::string_view name) {
  const std::string w = wordsOf(name);
  const bool left = has(w, {"left"}), right = has(w, {"right"});
  if (has(w, {"papillary"})) return Role::papillary_muscle;
  if (has(w, {"pericard"})) return Role::pericardium;
  if (has(w, {"mitral"})) return Role::mitral_valve;
  if (has(w, {"tricuspid"})) return Role::tricuspid_valve;
  if (has(w, {"aortic_valve", "aortic_left", "aortic_right", "aortic_non"}))
    return Role::aortic_valve;
  if (has(w, {"pulmonary_valve", "pulmonic_valve", "pulmonary_left", "pulmonary_right",
              "pulmonary_anterior"}))
    return Role::pulmonary_valve;
  if (has(w, {"aorta", "aortic", "_ao_"}))
    return has(w, {"wall"}) ? Role::aortic_wall : Role::aorta;
  if (has(w, {"pulmonary", "_pa_"}))
    return has(w, {"wall"}) ? Role::pulmonary_wall : Role::pulmonary_artery;
  if (has(w, {"_lv", "lv_"}) || (left && has(w, {"ventric"})))
    return chamber(w, Role::lv_cavity, Role::lv_wall);
  if (has(w, {"_rv", "rv_"}) || (right && has(w, {"ventric"})))
    return chamber(w, Role::rv_cavity, Role::rv_wall);
  if (has(w, {"_la_"}) || (left && has(w, {"atri"}))) return chamber(w, Role::la, Role::la_wall);
  if (has(w, {"_ra_"}) || (right && has(w, {"atri"}))) return chamber(w, Role::ra, Role::ra_wall);
  // An outer surface, filled, is the wall.
  if (has(w, {"_epi", "myocardium"}) || w == "_wall_") return Role::lv_wall;
  if (has(w,
          {"lung", "chest", "abdomen", "diaphragm", "mediastin", "rib", "grooves", "_fat", "skin"}))
    return Role::surroundings;
  return Role::none;
}

Role roleOf(const Structure& structure) {
  return structure.role != Role::none ? structure.role : guessRole(structure.name);
}

std::optional<SurfaceId> structureOf(const Scene& scene, Role role) {
  for (std::size_t s = 0; s < scene.structures.size(); ++s)
    if (roleOf(scene.structures[s]) == role) return static_cast<SurfaceId>(s);
  return std::nullopt;
}

bool hasTrabeculae(const Scene& scene, const Structure& structure) {
  if (!(scene.trabeculae.deviation_m > 0) || structure.membrane) return false;
  const Role role = roleOf(structure);
  return role == Role::lv_cavity || role == Role::rv_cavity;
}

double leafletThickness(const Scene& scene, const Structure& structure) {
  if (!structure.membrane) return 0;
  switch (roleOf(structure)) {
    case Role::mitral_valve:
    case Role::tricuspid_valve:
      return scene.leaflets.thickness_m;
    case Role::aortic_valve:
    case Role::pulmonary_valve:
      return scene.leaflets.cusp_m;
    default:
      return 0;
  }
}

bool hasThickness(const Scene& scene, const Structure& structure) {
  return leafletThickness(scene, structure) > 0;
}

double trabeculaeReach(const Scene& scene, const Structure& structure) {
  const Role role = roleOf(structure);
  const bool wall = role == Role::lv_wall || role == Role::rv_wall;
  return hasTrabeculae(scene, structure) || (wall && !structure.membrane)
             ? scene.trabeculae.most_m()
             : 0;
}

}  // namespace echocine
