#pragma once
// Caveats reported with the results of a fit.

#include <string>
#include <vector>

#include "echo/echo_loop.h"
#include "fit/model_discrepancy.h"

namespace echocine::fit {

// A result with a lower confidence (Eq. 8) is a hint: correct and wrong results lie below. Our
// choice.
inline constexpr double kLeastConfidence = 0.1;

// One clause each: low confidence, unknown scale, a loop assumed to be one beat.
std::vector<std::string> caveatsOf(const echo::EchoLoop& real, const BeatFound& beat,
                                   double confidence);

}  // namespace echocine::fit
