#include "scene/truth_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/key_reader.h"
#include "scene/names.h"
#include "scene/role.h"

namespace echocine {

namespace {

// Tracks and function need both; what lacks is said once.
bool hasVentricle(Scene& scene) {
  std::string lacking;
  for (const Role role : {Role::lv_cavity, Role::lv_wall})
    if (!structureOf(scene, role))
      lacking += (lacking.empty() ? "" : ", none has the role ") + std::string(nameOf(role));
  if (lacking.empty()) return true;
  const std::string warning = fmt::format(
      "truth \"all\" omits tracks and function: no structure has the role {}; set role", lacking);
  if (std::find(scene.warnings.begin(), scene.warnings.end(), warning) == scene.warnings.end())
    scene.warnings.push_back(warning);
  return false;
}

}  // namespace

std::string switchOn(const std::vector<std::string>& kinds, Scene& scene) {
  TruthSettings& truth = scene.truth;
  for (const std::string& kind : kinds) {
    const bool all = kind == "all";
    if (!all && kind != "labels" && kind != "contours" && kind != "tracks" && kind != "function")
      return kind;
    truth.labels |= all || kind == "labels";
    truth.contours |= all || kind == "contours";
    const bool ventricle = all && hasVentricle(scene);
    truth.tracks |= ventricle || kind == "tracks";
    truth.function |= ventricle || kind == "function";
  }
  return {};
}

namespace {

// Each number once, each name a closed structure or the role of one.
void checkNumbers(const TomlTable& table, const TruthSettings& truth, const Scene& scene) {
  for (std::size_t i = 0; i < truth.label_numbers.size(); ++i) {
    const std::string& name = truth.label_numbers[i].first;
    const int number = truth.label_numbers[i].second;
    const bool known =
        std::any_of(scene.structures.begin(), scene.structures.end(), [&](const Structure& s) {
          return !s.membrane && (s.name == name || nameOf(roleOf(s)) == name);
        });
    if (!known)
      table.fail("labels",
                 fmt::format("{} is not a closed structure of the scene, nor the role of one, "
                             "accepted: names and roles of closed structures",
                             name));
    for (std::size_t j = 0; j < i; ++j)
      if (truth.label_numbers[j].second == number)
        table.fail("labels",
                   fmt::format("{} and {} both have number {}, accepted: each number once",
                               truth.label_numbers[j].first, name, number));
  }
}

}  // namespace

void readTruth(TomlTable table, Scene& scene) {
  TruthSettings& truth = scene.truth;
  const std::string unknown = switchOn(table.texts("write"), scene);
  if (!unknown.empty())
    table.fail("write",
               fmt::format("\"{}\" is not a kind of truth, accepted: {}", unknown, kTruthKinds));
  const NumberRange numbers = sceneKey("truth", "labels").range;
  truth.label_numbers =
      table.namedIntegers("labels", static_cast<int>(numbers.lo), static_cast<int>(numbers.hi));
  truth.labels_place = table.place("labels");
  truth.tracks_place = table.place("tracks");
  truth.function_place = table.place("write");
  checkNumbers(table, truth, scene);
  readKeys(table, "truth", {&scene});
  table.finish();
}

}  // namespace echocine
