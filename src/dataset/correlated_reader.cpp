#include "dataset/correlated_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/cholesky.h"

namespace echocine::dataset {

namespace {

// Above the diagonal, row by row; a single one for all pairs.
std::vector<double> readFactor(TomlTable& table, std::size_t n) {
  std::vector<double> upper = table.numbers("correlations");
  if (upper.size() == 1) upper.assign(n * (n - 1) / 2, upper.front());
  if (upper.size() != n * (n - 1) / 2)
    table.fail("correlations", fmt::format("are {}, accepted: 1, or {}, one for each pair: of the "
                                           "first with all that follow, of the second, ...",
                                           upper.size(), n * (n - 1) / 2));
  std::vector<double> matrix(n * n, 1);
  std::size_t at = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) matrix[i * n + j] = matrix[j * n + i] = upper[at++];
  std::vector<double> factor = choleskyFactor(matrix, n);
  if (factor.empty())
    table.fail("correlations", "contradict each other, or are not within -1 and 1: lower them");
  return factor;
}

}  // namespace

void readCorrelated(TomlTable& file, Spec& spec) {
  std::vector<std::string> taken;
  for (TomlTable& table : file.tables("correlated")) {
    CorrelatedGroup group;
    group.names = table.texts("parameters");
    if (group.names.size() < 2) table.fail("parameters", "are fewer than two, accepted: names");
    for (const std::string& name : group.names) {
      const auto has = [&](const std::vector<Parameter>& list) {
        return std::any_of(list.begin(), list.end(),
                           [&](const Parameter& p) { return p.name == name; });
      };
      // Segments of a built-in infarct are drawn jointly with its ejection fraction.
      const bool of_segments = name.starts_with("heart.segments.");
      const bool known =
          has(spec.parameters) ||
          std::any_of(spec.populations.begin(), spec.populations.end(), [&](const Population& p) {
            return has(p.parameters) && !(p.group && of_segments);
          });
      if (!known)
        table.fail("parameters",
                   fmt::format("\"{}\" is not drawn by itself in this spec, accepted: names "
                               "of its distributions, such as offset.tilt_deg",
                               name));
      if (std::find(taken.begin(), taken.end(), name) != taken.end())
        table.fail("parameters", fmt::format("\"{}\" is correlated twice, accepted: once", name));
      if (isOfHeart(name) != isOfHeart(group.names.front()))
        table.fail("parameters", fmt::format("\"{}\" and \"{}\" are not drawn together: one is the "
                                             "heart's, the other a view's",
                                             name, group.names.front()));
      taken.push_back(name);
    }
    group.factor = readFactor(table, group.names.size());
    table.finish();
    spec.correlated.push_back(std::move(group));
  }
}

}  // namespace echocine::dataset
