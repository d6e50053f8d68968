#include "dataset/draws.h"

#include <algorithm>
#include <cmath>

#include "core/hash_random.h"
#include "dataset/index_draws.h"

namespace echocine::dataset {

namespace {

// FNV-1a of 64 bits (Fowler, Noll, Vo), to give a name a number.
std::uint64_t numberOf(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

struct Place {
  const Spec& spec;
  int heart, attempt, view;  // view -1: of the heart

  std::uint64_t hash(std::string_view name) const {
    return hashFor(spec, name, heart, attempt, view);
  }
  double normal(const std::string& name) const {
    return normalFromHashes(hash(name + "/radius"), hash(name + "/angle"));
  }
};

// A Gaussian copula: correlated normals, each turned into its share of the normal distribution.
std::optional<double> correlatedShare(const Place& place, const std::string& name) {
  constexpr double kLeast = 1e-15;  // a share is never an end
  for (const CorrelatedGroup& group : place.spec.correlated) {
    const auto found = std::find(group.names.begin(), group.names.end(), name);
    if (found == group.names.end()) continue;
    const std::size_t n = group.names.size();
    const auto row = static_cast<std::size_t>(found - group.names.begin());
    double z = 0;
    for (std::size_t j = 0; j <= row; ++j)
      z += group.factor[row * n + j] * place.normal(group.names[j]);
    return std::clamp(normalCumulative(z), kLeast, 1 - kLeast);
  }
  return std::nullopt;
}

TomlValue valueAt(const Place& place, const Parameter& parameter) {
  if (!parameter.distribution.varies()) return parameter.distribution.quantile(0.5);
  const std::optional<double> share = correlatedShare(place, parameter.name);
  return parameter.distribution.quantile(share ? *share
                                               : uniformFromHash(place.hash(parameter.name)));
}

// The values of an infarct's segments: a copula with the ejection fraction, because small infarcts
// leave a better ventricle. The correlation is our choice.
double infarctShare(const Place& place, const std::string& name, double ejection_score) {
  constexpr double kCorrelation = 0.8;
  return normalCumulative(kCorrelation * ejection_score +
                          std::sqrt(1 - kCorrelation * kCorrelation) * place.normal(name));
}

// Adds the jointly drawn dials, the body surface and the sex, except what the spec itself gives.
// The ejection fraction is that of the whole ventricle: other segments compensate for an infarct.
void addIndexDraws(const Place& place, const Population& population, Values& values) {
  const auto sex = values.try_emplace(
      "subject.sex", std::string(uniformFromHash(place.hash("subject.sex")) < 0.5 ? "F" : "M"));
  const bool woman = sex.first->second == TomlValue(std::string("F"));
  const IndexDraws::Drawn drawn =
      IndexDraws::of(*population.group)
          .draw(woman ? kWomenSurface_m2 : kMenSurface_m2, [&](std::size_t number) {
            return place.normal("index/" + std::to_string(number));
          });
  for (std::size_t i = 0; i < heart::kIndexDialCount; ++i)
    values.try_emplace(std::string("heart.") + heart::kIndexDials[i], drawn.dials[i]);
  values.try_emplace("heart.body-scale", std::sqrt(drawn.body_surface_m2 / heart::kBodySurface_m2));
  values["subject.body_surface_m2"] = drawn.body_surface_m2;
  for (const Parameter& p : population.parameters)
    if (p.name.starts_with("heart.segments.")) {
      values["heart.rule"] = std::string("volumes");
      if (!place.spec.gives(p.name))
        values[p.name] = p.distribution.quantile(infarctShare(place, p.name, drawn.ejection_score));
    }
}

const Population& populationAt(const Spec& spec, int heart, int attempt) {
  if (!spec.scenes.empty())
    return spec.populations[static_cast<std::size_t>(heart) % spec.scenes.size()];
  double u = uniformFromHash(hashFor(spec, "population", heart, attempt));
  for (const Population& population : spec.populations)
    if ((u -= population.weight) < 0) return population;
  return spec.populations.back();
}

}  // namespace

std::uint64_t hashFor(const Spec& spec, std::string_view purpose, int heart, int attempt,
                      int view) {
  return hashOf(spec.seed, numberOf(purpose), heart, attempt, view);
}

Values Draw::valuesOf(std::size_t view) const {
  Values all = values;
  all.insert(view_values[view].begin(), view_values[view].end());
  return all;
}

// An impossible draw is drawn again as a whole, but from the same population: else those that are
// often impossible would be rarer than the spec says.
Draw drawOf(const Spec& spec, int heart, int attempt) {
  Draw draw{heart, attempt, &populationAt(spec, heart, 0), {}, {}};
  draw.view_values.resize(spec.views.size());
  for (const Parameter& parameter : spec.parametersOf(*draw.population)) {
    if (isOfHeart(parameter.name)) {
      draw.values[parameter.name] = valueAt({spec, heart, attempt, -1}, parameter);
      continue;
    }
    for (std::size_t v = 0; v < spec.views.size(); ++v)
      draw.view_values[v][parameter.name] =
          valueAt({spec, heart, attempt, static_cast<int>(spec.views[v])}, parameter);
  }
  if (draw.population->group)
    addIndexDraws({spec, heart, attempt, -1}, *draw.population, draw.values);
  return draw;
}

}  // namespace echocine::dataset
