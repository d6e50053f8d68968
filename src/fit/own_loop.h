#pragma once
// A loop of a parametric heart as this program renders it: a model compared with itself shows the
// error of the comparison.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "echo/echo_loop.h"
#include "fit/plane_tilt.h"
#include "motion/heart/heart_scene.h"

namespace echocine {
class Simulator;
}

namespace echocine::fit {

// One beat of a scene as echo loops of `frames` pictures from end-diastole, 360 x 300 pixels. A
// seed is that of speckle, noise and clutter. Loops share the motion of meshes and tissue.
class RenderedBeats {
 public:
  RenderedBeats(Scene scene, int frames);
  RenderedBeats(RenderedBeats&& other) noexcept;
  ~RenderedBeats();

  // Throws like Simulator. Runs in parallel.
  echo::EchoLoop loop(int seed);

 private:
  Scene scene_;
  int frames_;
  std::unique_ptr<const Simulator> first_;  // null before the first loop
};

// The only loop of a scene.
inline echo::EchoLoop renderedBeat(Scene scene, int frames, int seed) {
  return RenderedBeats(std::move(scene), frames).loop(seed);
}

// Loops of a heart, with the plane tilted. persistence: none for that of the look. Throws
// SceneError for impossible dials.
RenderedBeats ownLoops(const std::map<std::string, double>& dials, heart::View view,
                       const PlaneTilt& tilt, int frames, Look look = Look::scanner,
                       std::optional<double> persistence = {});

}  // namespace echocine::fit
