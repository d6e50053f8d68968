#pragma once
// A loop of a parametric heart as this program renders it: a model compared with itself shows the
// error of the comparison.

#include <map>
#include <string>

#include "echo/echo_loop.h"
#include "fit/plane_tilt.h"
#include "motion/heart/heart_scene.h"

namespace echocine::fit {

// One beat of `frames` pictures from end-diastole, look scanner, with the plane tilted. The seed is
// that of speckle, noise and clutter. Throws SceneError for impossible dials. Runs in parallel.
echo::EchoLoop ownLoop(const std::map<std::string, double>& dials, heart::View view,
                       const PlaneTilt& tilt, int frames, int seed);

}  // namespace echocine::fit
