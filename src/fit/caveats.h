#pragma once
// Caveats that stand beside the numbers of a fit.

#include <string>
#include <vector>

#include "echo/echo_loop.h"
#include "fit/model_discrepancy.h"

namespace echocine::fit {

// A result with less confidence (Eq. 8) is a hint: right ones and wrong ones lie below. Our choice.
inline constexpr double kLeastConfidence = 0.1;

// One clause each: a hint, an unknown scale, a loop that was taken for a beat.
std::vector<std::string> caveatsOf(const echo::EchoLoop& real, const BeatFound& beat,
                                   double confidence);

}  // namespace echocine::fit
