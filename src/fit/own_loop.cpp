#include "fit/own_loop.h"

#include <utility>

#include "core/parallel.h"
#include "frame/simulator.h"
#include "motion/surfaces/probe_placement.h"
#include "signal/signal_chain.h"

namespace echocine::fit {

echo::EchoLoop renderedBeat(Scene scene, int frames, int seed) {
  scene.speckle.seed = scene.speckle.heterogeneity_seed = seed;
  scene.artefacts.noise_seed = scene.artefacts.clutter_seed = seed;
  scene.acquisition.frame_rate_hz = frames * scene.acquisition.heart_rate_hz;
  scene.acquisition.beats = 1;
  // Pixels of about 0.5 mm.
  scene.output.width = 360;
  scene.output.height = 300;
  scene.output.ecg = scene.output.depth_ticks = false;
  const Simulator simulator(scene);
  const Probe& p = simulator.scene().probe;
  const PictureGeometry& g = simulator.chain().geometry();
  echo::EchoLoop loop;
  loop.video.name = "rendered beat";
  loop.video.width = scene.output.width;
  loop.video.height = scene.output.height;
  loop.video.rate = {scene.acquisition.frame_rate_hz, "own", true};
  loop.metres_per_pixel = g.metres_per_pixel;
  loop.frames_per_beat = frames;
  loop.find.sector = {g.origin_x_px,
                      g.origin_y_px,
                      p.first_angle_rad,
                      p.last_angle_rad,
                      (p.face_radius_m + p.min_depth_m) / g.metres_per_pixel,
                      (p.face_radius_m + p.max_depth_m) / g.metres_per_pixel};
  loop.video.frames.resize(static_cast<std::size_t>(frames));
  simulator.referenceIntensity();
  parallelBlocks(loop.video.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      loop.video.frames[i] =
          simulator.frame(static_cast<double>(i) / scene.acquisition.frame_rate_hz).image.pixels;
  });
  loop.overlay.assign(loop.video.frames.front().size(), 0);
  loop.video.coloured.assign(loop.overlay.size(), 0);
  return loop;
}

echo::EchoLoop ownLoop(const std::map<std::string, double>& dials, heart::View view,
                       const PlaneTilt& tilt, int frames, int seed) {
  Scene scene = heart::heartScene(heart::parametersFrom(dials), view, frames, Look::scanner);
  scene.probe.pose = turnedAndTilted(scene.probe.pose, tilt.rotate_rad, tilt.tilt_rad);
  return renderedBeat(std::move(scene), frames, seed);
}

}  // namespace echocine::fit
