#pragma once
// Pairs the instants of two loops by information from files and user.

#include "compare/compare.h"

namespace echocine::compare {

// Uses end-diastole and end-systole if the real side has them, else R waves, else similarity.
// Throws SceneError for a frame that is not in its loop, and for one without a partner.
TimeAlignment alignByWhatIsKnown(const CompareOptions& options, const TimeProblem& problem,
                                 const echo::EchoLoop& synthetic, const echo::EchoLoop& real);

}  // namespace echocine::compare
