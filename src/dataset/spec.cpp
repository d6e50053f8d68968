#include "dataset/spec.h"

#include <algorithm>
#include <cmath>

namespace echocine::dataset {

bool isOfHeart(std::string_view name) {
  return name.starts_with("heart.") || name.starts_with("subject.") ||
         name.starts_with("scene.acquisition.");
}

bool Spec::has(std::string_view layout) const {
  return std::find(layouts.begin(), layouts.end(), layout) != layouts.end();
}

Split Spec::splitOf(int heart) const {
  const auto until = [this](double share) { return std::llround(share * hearts); };
  if (heart < until(split[0])) return Split::train;
  return heart < until(split[0] + split[1]) ? Split::val : Split::test;
}

std::vector<Parameter> Spec::parametersOf(const Population& population) const {
  std::vector<Parameter> all = parameters;
  for (const Parameter& one : population.parameters) {
    const bool given = std::any_of(parameters.begin(), parameters.end(),
                                   [&](const Parameter& p) { return p.name == one.name; });
    if (!given) all.push_back(one);
  }
  std::sort(all.begin(), all.end(),
            [](const Parameter& a, const Parameter& b) { return a.name < b.name; });
  return all;
}

}  // namespace echocine::dataset
