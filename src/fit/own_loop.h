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
class MeshMotion;
class MotionField;
class Simulator;
}  // namespace echocine

namespace echocine::fit {

// One beat of a scene as echo loops of `frames` pictures from end-diastole, 360 x 300 pixels. A
// seed is that of speckle, noise and clutter. Loops share the motion of meshes and tissue.
class RenderedBeats {
 public:
  RenderedBeats(Scene scene, int frames);
  // Shares the motion of `other` too, which has made a loop. Precondition: the same heart and plane
  // in looks of scannerLooks().
  RenderedBeats(Scene scene, int frames, const RenderedBeats& other);
  RenderedBeats(RenderedBeats&& other) noexcept;
  ~RenderedBeats();

  // Throws like Simulator. Runs in parallel.
  echo::EchoLoop loop(int seed);

 private:
  Scene scene_;
  int frames_;
  std::unique_ptr<const Simulator> first_;  // null before the first loop
  // Those of another look; null: none.
  std::shared_ptr<const MeshMotion> motion_;
  std::shared_ptr<const MotionField> field_;
};

// The only loop of a scene.
inline echo::EchoLoop renderedBeat(Scene scene, int frames, int seed) {
  return RenderedBeats(std::move(scene), frames).loop(seed);
}

// A heart whose own loops have the plane tilted, and in several looks the same meshes.
class OwnHeart {
 public:
  // Throws SceneError for impossible dials.
  OwnHeart(const std::map<std::string, double>& dials, heart::View view, const PlaneTilt& tilt,
           int frames);
  OwnHeart(OwnHeart&& other) noexcept;
  ~OwnHeart();

  // persistence: none for that of the look. `other`: beats of another look, which have made a
  // loop; null: none. Both are then scannerLooks(). Thread-safe.
  RenderedBeats beats(Look look = Look::scanner, std::optional<double> persistence = {},
                      const RenderedBeats* other = nullptr) const;

 private:
  heart::Parameters parameters_;
  heart::View view_;
  PlaneTilt tilt_;
  int frames_;
  std::unique_ptr<const heart::Recording> recording_;
};

}  // namespace echocine::fit
