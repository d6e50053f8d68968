#pragma once
// Names of the standard views in scenes and on the command line.

#include <optional>
#include <span>
#include <string_view>

#include "scene/view_placement.h"

namespace echocine {

struct ViewName {
  View view;
  const char* key;  // such as "a4c"
  const char* meaning;
};
std::span<const ViewName> viewNames();

// Words may be joined by "-" or "_".
std::optional<View> viewOf(std::string_view key);

const char* keyOf(View view);

}  // namespace echocine
