#include "dataset/draws.h"

#include <algorithm>

#include "core/hash_random.h"

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
  return draw;
}

}  // namespace echocine::dataset
