#pragma once
// The views' names, as options list them.

#include <string>

namespace echocine {

// "a4c, a2c, ...", from the heart's own table: a new view needs no change here.
std::string viewList(const char* between = ", ");

// The same as an option's type: "{a4c,a2c,...}", which completions of shells offer.
std::string viewChoice();

}  // namespace echocine
