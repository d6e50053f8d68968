#include "cli/view_list.h"

#include <fmt/format.h>

#include "motion/heart/heart_poses.h"

namespace echocine {

std::string viewList(const char* between) {
  std::string list;
  for (const heart::ViewName& name : heart::viewNames())
    list += fmt::format("{}{}", list.empty() ? "" : between, name.key);
  return list;
}

std::string viewChoice() {
  return fmt::format("{{{}}}", viewList(","));
}

}  // namespace echocine
