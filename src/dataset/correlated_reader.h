#pragma once
// Correlations between a dataset's parameters, from its spec.

#include "dataset/spec.h"

namespace echocine::dataset {

// [[correlated]] with parameters and correlations. Precondition: the spec's parameters and
// populations are read. Throws SceneError.
void readCorrelated(TomlTable& file, Spec& spec);

}  // namespace echocine::dataset
