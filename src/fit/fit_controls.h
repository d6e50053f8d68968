#pragma once
// Loops that a found heart must not fit: the mirror image of its loop, and its pictures shuffled.

#include "echo/echo_loop.h"
#include "fit/model_discrepancy.h"

namespace echocine::fit {

// D of one heart at its best pose in three loops of the same pictures.
struct ControlFits {
  double own = 0;       // the loop itself
  double mirrored = 0;  // left and right exchanged
  double shuffled = 0;  // out of their order in time
};

// The beat as kFitFrames pictures from end-diastole, each the nearest of the loop.
echo::EchoLoop beatOnly(const echo::EchoLoop& loop, const echo::BeatSpan& beat);
echo::EchoLoop mirrored(echo::EchoLoop loop);
// The order is the same for all loops of one length.
echo::EchoLoop shuffled(echo::EchoLoop loop);

// `from`: the heart's pose in the loop. Poses are searched globally. Runs in parallel; the result
// does not depend on the threads.
ControlFits controlFits(const echo::EchoLoop& loop, const echo::BeatSpan& beat,
                        const ModelLoop& heart, const FitPose& from);

}  // namespace echocine::fit
