#pragma once
#include <string>

namespace echocine {

// What a scene says about an effect: is it called for, and why or why not.
struct Finding {
  bool on;
  std::string reason;
};

}  // namespace echocine
