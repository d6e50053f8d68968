#include "dataset/preview_frames.h"

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "dataset/aim.h"
#include "dataset/redraw.h"
#include "frame/simulator.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/heart/heart_scene.h"
#include "motion/heart/recording.h"
#include "motion/surfaces/mesh_motion.h"

namespace echocine::dataset {

namespace {

struct Instant {
  double time_s = 0, ml = 0;
};

// The frames of the largest and the smallest ventricle in the first beat.
std::pair<Instant, Instant> extremesOf(const Simulator& simulator) {
  const CardiacClock& clock = simulator.cardiacClock();
  const SurfaceTopology& cavity =
      simulator.motion().surfaces()[index(*structureOf(simulator.scene(), Role::lv_cavity))];
  Instant ed, es;
  SurfaceFrame surfaces;
  for (int i = 0; i < clock.frameCount() && clock.at(i).beat == 0; ++i) {
    const FrameTime time = clock.at(i);
    simulator.motion().positionsAt(time.phase, {&cavity.id, 1}, surfaces);
    const double ml = millilitresFromCubicMetres(simulator.motion().volumeIn(surfaces, cavity));
    if (i == 0 || ml > ed.ml) ed = {time.time_s, ml};
    if (i == 0 || ml < es.ml) es = {time.time_s, ml};
  }
  return {ed, es};
}

Scene drawnScene(const Spec& spec, const Draw& draw, std::size_t view) {
  if (!spec.scenes.empty()) return sceneOf(spec, draw, view);
  const heart::ParametricHeart model = modelOf(spec, draw.values);
  heart::Recording recording = recordBeat(model, spec.views[view], spec.keyframes);
  surroundProbe(spec, draw, view, model, recording);
  return sceneOf(spec, draw, view, model.parameters(), recording);
}

PreviewFrames previewOf(const Spec& spec, const Draw& draw, std::size_t view) {
  Scene scene = drawnScene(spec, draw, view);
  scene.truth = {};
  const Simulator simulator(scene);
  const auto [ed, es] = extremesOf(simulator);
  return {loopId(draw.heart + 1, spec.views[view]),
          draw.population->name,
          spec.views[view],
          ed.ml,
          es.ml,
          simulator.frame(ed.time_s).image,
          simulator.frame(es.time_s).image,
          draw.valuesOf(view),
          draw.attempt};
}

}  // namespace

PreviewFrames previewFramesOf(const Spec& spec, int heart, std::size_t view,
                              const Monitor& monitor) {
  std::optional<PreviewFrames> made;
  std::vector<std::string> impossible;
  inThisThread([&] {
    made = firstPossible(
        spec, heart,
        [&](const Draw& draw) {
          if (!monitor.keep_going()) throw JobError("stopped");
          return previewOf(spec, draw, view);
        },
        impossible);
  });
  return std::move(*made);
}

}  // namespace echocine::dataset
