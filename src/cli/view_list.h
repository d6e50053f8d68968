#pragma once
// The views' names, from the heart's own table: a new view needs no change here.

#include <string>

#include <fmt/format.h>

#include "motion/heart/views.h"

namespace echocine {

inline std::string viewList() {
  std::string list;
  for (const heart::ViewName& name : heart::viewNames())
    list += fmt::format("{}{}", list.empty() ? "" : ", ", name.key);
  return list;
}

}  // namespace echocine
