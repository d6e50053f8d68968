#pragma once
#include <string>

namespace echocine {

// Whether a scene calls for an effect, and the reason.
struct Finding {
  bool on;
  std::string reason;
};

}  // namespace echocine
