#pragma once
// The views' names, as options list them.

#include <string>

namespace echocine {

// "a4c, a2c, ...", from the heart's own table: a new view needs no change here.
std::string viewList();

}  // namespace echocine
