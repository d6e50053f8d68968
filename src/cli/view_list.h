#pragma once
// Names of the views, for options.

#include <string>

namespace echocine {

// "a4c, a2c, ...", from the heart's table: a new view needs no change here.
std::string viewList(const char* between = ", ");

// The same as an option's type, "{a4c,a2c,...}", which shell completions offer.
std::string viewChoice();

}  // namespace echocine
