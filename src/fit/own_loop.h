#pragma once
// A loop of a parametric heart as this program renders it: a model compared with itself shows the
// error of the comparison.

#include <map>
#include <string>

#include "echo/echo_loop.h"
#include "fit/plane_tilt.h"
#include "motion/heart/heart_scene.h"

namespace echocine::fit {

// One beat of a scene as an echo loop of `frames` pictures from end-diastole, 360 x 300 pixels. The
// seed is that of speckle, noise and clutter. Throws like Simulator. Runs in parallel.
echo::EchoLoop renderedBeat(Scene scene, int frames, int seed);

// renderedBeat() of a heart in the look scanner, with the plane tilted. Throws SceneError for
// impossible dials.
echo::EchoLoop ownLoop(const std::map<std::string, double>& dials, heart::View view,
                       const PlaneTilt& tilt, int frames, int seed);

}  // namespace echocine::fit
