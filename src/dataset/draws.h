#pragma once
// What each heart of a dataset is drawn as. A draw is a hash of the spec's seed, the heart, the
// attempt and the parameter's name (and the view's, where views differ): never of order, threads,
// tasks or how many there are.

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

  // Of the heart and of one of the views.
  Values valuesOf(std::size_t view) const;
};

Draw drawOf(const Spec& spec, int heart, int attempt);

// A number of 64 bits for a purpose of a heart's view, as parameters have them.
std::uint64_t hashFor(const Spec& spec, std::string_view purpose, int heart, int attempt,
                      int view = -1);

// The lower factor of a matrix of correlations, row by row; empty where it is none (not positive
// definite). Precondition: size * size entries.
std::vector<double> choleskyFactor(const std::vector<double>& correlations, std::size_t size);

}  // namespace echocine::dataset
