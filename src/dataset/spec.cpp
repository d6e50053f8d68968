#include "dataset/spec.h"

#include <algorithm>
#include <cmath>

namespace echocine::dataset {

bool isOfHeart(std::string_view name) {
  constexpr const char* kSharedByViews[] = {"heart.", "subject.", "scene.acquisition.",
                                            "scene.trabeculae.", "scene.leaflets."};
  return std::any_of(std::begin(kSharedByViews), std::end(kSharedByViews),
                     [&](const char* prefix) { return name.starts_with(prefix); });
}

bool Spec::has(std::string_view layout) const {
  return std::find(layouts.begin(), layouts.end(), layout) != layouts.end();
}

bool Spec::wants(std::string_view truth_kind) const {
  return std::find(truth.begin(), truth.end(), truth_kind) != truth.end();
}

bool Spec::hasExactEf(std::string_view layout) const {
  return std::find(exact_ef.begin(), exact_ef.end(), layout) != exact_ef.end();
}

bool Spec::wantsTracks() const {
  return wants("tracks") || has("pointodyssey") || has("myotracker");
}

Split Spec::splitOf(int heart) const {
  int all = scenes.empty() ? hearts : static_cast<int>(scenes.size());
  int number = scenes.empty() ? heart : heart % all;
  if (scenes.empty() && blocks.size() > 1) {
    std::size_t block = 0;
    while (block + 1 < blocks.size() && number >= blocks[block]) number -= blocks[block++];
    all = blocks[block];
  }
  const auto until = [all](double share) { return std::llround(share * all); };
  if (number < until(split[0])) return Split::train;
  return number < until(split[0] + split[1]) ? Split::val : Split::test;
}

const UserScene& Spec::sceneOf(int heart) const {
  return scenes[static_cast<std::size_t>(heart) % scenes.size()];
}

bool Spec::gives(std::string_view parameter) const {
  return std::any_of(parameters.begin(), parameters.end(),
                     [&](const Parameter& p) { return p.name == parameter; });
}

std::vector<Parameter> Spec::parametersOf(const Population& population) const {
  std::vector<Parameter> all = parameters;
  for (const Parameter& one : population.parameters)
    if (!gives(one.name)) all.push_back(one);
  std::sort(all.begin(), all.end(),
            [](const Parameter& a, const Parameter& b) { return a.name < b.name; });
  return all;
}

}  // namespace echocine::dataset
