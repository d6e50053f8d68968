#pragma once
// The names of an enum's values, as an option's check takes them.

#include <string>
#include <vector>

#include "scene/names.h"

namespace echocine {

template <typename Enum>
std::vector<std::string> enumNames() {
  std::vector<std::string> names;
  for (const auto& one : NamesOf<Enum>::kAll) names.emplace_back(one.name);
  return names;
}

}  // namespace echocine
