#pragma once
// The cheapest setting of a scene's knobs whose picture stays within a tolerance.

#include "core/monitor.h"
#include "output/accuracy_record.h"
#include "scene/scene.h"
#include "study/knobs.h"

namespace echocine {

struct AccuracyChoice {
  Scene scene;  // with the setting's values
  AccuracyRecord record;
};

// The error of a setting: RMS over the sector, dB of the displayed range (picture_error.h), in the
// worst probe frame, against the preset `reference`. It must stay under tolerance /
// kToleranceSafety, since other frames may err more than those that are looked at. Our choices.
inline constexpr double kToleranceSafety = 1.25;
inline constexpr int kToleranceFrames = 4;

// Goes down from the reference, one knob one step at a time: next is the step that saved most
// modelled cost (cost_model.h) for the squared error it added when it was last tried; a step that
// errs too much is never tried again. The cheapest of all that were tried and stay within is taken:
// not exhaustive, but the reference itself always qualifies.
// Costs are counted, not timed, and pictures do not depend on threads, so the same scene and
// tolerance give the same choice in every run. All frames are compressed against one white: the
// scene's, or its percentile over the probe frames at the reference.
// Throws SceneError, and a JobError when keep_going() says no.
AccuracyChoice chooseWithin(const Scene& scene, double tolerance_db, int threads,
                            const Monitor& monitor);

// The scene at a preset.
AccuracyChoice atPreset(const Scene& scene, Preset preset);

}  // namespace echocine
