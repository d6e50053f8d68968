#pragma once
// The draws of a dataset. A draw is a hash of the spec's seed, the heart, the attempt and the
// parameter's name (and the view's, if views differ). It is independent of order, threads, tasks
// and counts.

#include <map>
#include <string>
#include <vector>

#include "dataset/spec.h"

namespace echocine::dataset {

using Values = std::map<std::string, TomlValue>;

struct Draw {
  int heart = 0;    // from 0
  int attempt = 0;  // impossible draws before this one
  const Population* population = nullptr;
  Values values;                    // of the heart
  std::vector<Values> view_values;  // of each view of the spec

  // Values of the heart and of one of its views.
  Values valuesOf(std::size_t view) const;
};

Draw drawOf(const Spec& spec, int heart, int attempt);

// A 64-bit number for a purpose of a heart's view, like those of parameters.
std::uint64_t hashFor(const Spec& spec, std::string_view purpose, int heart, int attempt,
                      int view = -1);

}  // namespace echocine::dataset
