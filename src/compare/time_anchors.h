#pragma once
// Pairs the instants of two loops by what files and user say of them.

#include "compare/compare.h"

namespace echocine::compare {

// By end-diastole and end-systole when the real side has them, else by R waves, else by what moves.
// Throws SceneError for a frame that is not in its loop, and for one without a partner.
TimeAlignment alignByWhatIsKnown(const CompareOptions& options, const TimeProblem& problem,
                                 const echo::EchoLoop& synthetic, const echo::EchoLoop& real);

}  // namespace echocine::compare
