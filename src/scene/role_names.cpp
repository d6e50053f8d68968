#include "scene/role_names.h"

#include <algorithm>
#include <cctype>

namespace echocine {

namespace {

// Beginnings of names and what they mean, the more particular first.
struct Guess {
  const char* beginning;
  const char* role;
};
constexpr Guess kGuesses[] = {{"papillary", "papillary_muscle"},
                              {"lv_cavity", "lv_cavity"},
                              {"lv_endo", "lv_cavity"},
                              {"lv_wall", "lv_wall"},
                              {"lv_myo", "lv_wall"},
                              {"lv_epi", "lv_wall"},
                              {"myocardium", "lv_wall"},
                              {"wall", "lv_wall"},
                              {"epi", "lv_wall"},
                              {"rv_cavity", "rv_cavity"},
                              {"rv_endo", "rv_cavity"},
                              {"rv_wall", "rv_wall"},
                              {"la_wall", "la_wall"},
                              {"ra_wall", "ra_wall"},
                              {"aortic_wall", "aortic_wall"},
                              {"aortic", "aortic_valve"},
                              {"aorta", "aorta"},
                              {"mitral", "mitral_valve"},
                              {"tricuspid", "tricuspid_valve"}};
constexpr Guess kWholeNames[] = {
    {"lv", "lv_cavity"}, {"rv", "rv_cavity"}, {"la", "la"}, {"ra", "ra"}};

}  // namespace

std::string roleNameOf(const Structure& structure) {
  std::string name = structure.name;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const Guess& guess : kWholeNames)
    if (name == guess.beginning) return guess.role;
  for (const Guess& guess : kGuesses)
    if (name.starts_with(guess.beginning)) return guess.role;
  return {};
}

std::optional<SurfaceId> structureOf(const Scene& scene, std::string_view role) {
  for (std::size_t s = 0; s < scene.structures.size(); ++s)
    if (roleNameOf(scene.structures[s]) == role) return static_cast<SurfaceId>(s);
  return std::nullopt;
}

}  // namespace echocine
