#include "scene/truth_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/key_reader.h"
#include "scene/names.h"

namespace echocine {

std::string switchOn(const std::vector<std::string>& kinds, TruthSettings& truth) {
  for (const std::string& kind : kinds) {
    const bool all = kind == "all";
    if (!all && kind != "labels" && kind != "contours" && kind != "tracks" && kind != "function")
      return kind;
    truth.labels |= all || kind == "labels";
    truth.contours |= all || kind == "contours";
    truth.tracks |= all || kind == "tracks";
    truth.function |= all || kind == "function";
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
  const std::string unknown = switchOn(table.texts("write"), truth);
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
