#include "study/knob_builder.h"

#include <fmt/format.h>

namespace echocine {

void KnobBuilder::addNumbers(const char* name, const char* key, const char* meaning,
                             const std::vector<int>& numbers,
                             const std::array<std::size_t, kPresets>& of_preset,
                             const std::function<void(Scene&, int)>& apply) {
  Knob knob{name, key, meaning, {}, {}};
  std::vector<std::size_t> place;  // of each number among the values
  for (const int number : numbers) {
    const std::string label = std::to_string(number);
    if (knob.values.empty() || knob.values.back().label != label)
      knob.values.push_back({label, [=](Scene& scene) { apply(scene, number); }});
    place.push_back(knob.values.size() - 1);
  }
  for (std::size_t p = 0; p < kPresets; ++p) knob.of_preset[p] = place[of_preset[p]];
  for (std::size_t v = knob.of_preset[0]; v <= knob.reference(); ++v) knob.ladder.push_back(v);
  add(std::move(knob));
}

void KnobBuilder::add(Knob knob) {
  if (knob.ladder.empty())
    for (const std::size_t v : knob.of_preset)
      if (knob.ladder.empty() || knob.ladder.back() != v) knob.ladder.push_back(v);
  if (knob.values.size() < 2)
    leaveOut(knob.name, fmt::format("{} is its only value here", knob.values.at(0).label));
  else
    table.knobs.push_back(std::move(knob));
}

void KnobBuilder::leaveOut(const std::string& knob, const std::string& reason) {
  table.left_out.push_back({knob, reason});
}

}  // namespace echocine
