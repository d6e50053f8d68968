#include "dataset/structure_labels.h"

#include "scene/names.h"
#include "scene/role.h"

namespace echocine::dataset {

namespace {

// Roles of closed structures, in the order of their labels from 1 (our choice after CAMUS's three).
// Membranes have no area in the picture and no label.
struct LabelledRole {
  Role role;
  const char* name;
};
constexpr LabelledRole kLabelledRoles[] = {{Role::lv_cavity, "lv_cavity"},
                                           {Role::lv_wall, "lv_myocardium"},
                                           {Role::la, "la_cavity"},
                                           {Role::la_wall, "la_wall"},
                                           {Role::rv_cavity, "rv_cavity"},
                                           {Role::rv_wall, "rv_wall"},
                                           {Role::ra, "ra_cavity"},
                                           {Role::ra_wall, "ra_wall"},
                                           {Role::aorta, "aorta"},
                                           {Role::aortic_wall, "aortic_wall"},
                                           {Role::pulmonary_artery, "pulmonary_artery"},
                                           {Role::pulmonary_wall, "pulmonary_wall"},
                                           {Role::papillary_muscle, "papillary_muscle"},
                                           {Role::pericardium, "pericardium"},
                                           {Role::surroundings, "surroundings"}};
constexpr std::uint8_t kCavityLabel = 1, kCamusLabels = 3, kPapillaryLabel = 13;
static_assert(kLabelledRoles[kPapillaryLabel - 1].role == Role::papillary_muscle);

}  // namespace

std::vector<const char*> structureLabelNames() {
  std::vector<const char*> names{"background"};
  for (const LabelledRole& one : kLabelledRoles) names.push_back(one.name);
  return names;
}

std::vector<std::pair<std::string, int>> structureNumbers() {
  std::vector<std::pair<std::string, int>> numbers;
  for (const LabelledRole& one : kLabelledRoles)
    numbers.emplace_back(nameOf(one.role), static_cast<int>(numbers.size()) + 1);
  return numbers;
}

std::uint8_t camusLabel(std::uint8_t structure_label) {
  if (structure_label == kPapillaryLabel) return kCavityLabel;
  return structure_label <= kCamusLabels ? structure_label : std::uint8_t{0};
}

}  // namespace echocine::dataset
