#include "truth/label_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "scene/names.h"

namespace echocine {

namespace {

// A structure's own name counts before its role.
int numberOf(const Structure& structure, const TruthSettings& truth) {
  int number = 0;
  for (const auto& [name, n] : truth.label_numbers) {
    if (name == structure.name) return n;
    if (name == nameOf(roleOf(structure))) number = n;
  }
  return number;
}

}  // namespace

LabelTable labelTable(const Scene& scene) {
  LabelTable table;
  const TruthSettings& truth = scene.truth;
  int next = 0;
  for (const Structure& s : scene.structures) {
    int number = 0;
    if (!s.membrane) number = truth.label_numbers.empty() ? ++next : numberOf(s, truth);
    if (number > 255)
      throw SceneError(
          atPlace(truth.labels_place,
                  fmt::format("{} would be label {}, but 8-bit pictures end at 255: list "
                              "the wanted structures in truth.labels",
                              s.name, number)));
    table.numbers.push_back(static_cast<std::uint8_t>(number));
    if (number > 0 && truth.label_numbers.empty())
      table.entries.push_back({static_cast<std::uint8_t>(number), s.name});
  }
  for (const auto& [name, number] : truth.label_numbers)
    table.entries.push_back({static_cast<std::uint8_t>(number), name});
  if (const auto cavity = structureOf(scene, Role::lv_cavity); cavity && truth.papillary_in_cavity)
    for (std::size_t s = 0; s < scene.structures.size(); ++s)
      if (roleOf(scene.structures[s]) == Role::papillary_muscle)
        table.numbers[s] = table.numbers[index(*cavity)];
  std::sort(table.entries.begin(), table.entries.end(),
            [](const auto& a, const auto& b) { return a.number < b.number; });
  return table;
}

}  // namespace echocine
