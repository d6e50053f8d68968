#include "cli/view_list.h"

#include <fmt/format.h>

#include "motion/heart/views.h"

namespace echocine {

std::string viewList() {
  std::string list;
  for (const heart::ViewName& name : heart::viewNames())
    list += fmt::format("{}{}", list.empty() ? "" : ", ", name.key);
  return list;
}

}  // namespace echocine
