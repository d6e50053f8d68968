#pragma once
// The cheapest setting of a scene's knobs within a tolerance of the picture.

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
// worst test frame, against the preset `reference`. It must stay below tolerance /
// kToleranceSafety, because other frames may have larger errors. Our choices.
inline constexpr double kToleranceSafety = 1.25;
inline constexpr int kToleranceFrames = 4;

// Starts at the reference and relaxes one knob by one step at a time: the step that saved most
// modelled cost (cost_model.h) per added squared error when it was last tried. A step with too
// large an error is not tried again. The result is the cheapest of all accepted trials; the search
// is not exhaustive, but the reference always qualifies. Costs are counted, not timed, and pictures
// do not depend on threads, so the same scene and tolerance give the same choice in every run. All
// frames use one white: the scene's, or its percentile over the test frames at the reference.
// Throws SceneError, and JobError when keep_going() becomes false.
AccuracyChoice chooseWithin(const Scene& scene, double tolerance_db, int threads,
                            const Monitor& monitor);

// The same for the scene's own accuracy.tolerance_db. Without one, the scene as written.
AccuracyChoice atOwnTolerance(const Scene& scene, int threads, const Monitor& monitor);

// The scene at a preset.
AccuracyChoice atPreset(const Scene& scene, Preset preset);

}  // namespace echocine
