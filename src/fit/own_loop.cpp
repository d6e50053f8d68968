#include "fit/own_loop.h"

#include <utility>

#include "core/parallel.h"
#include "frame/scene_speckle.h"
#include "frame/simulator.h"
#include "motion/heart/recording.h"
#include "motion/surfaces/probe_placement.h"
#include "signal/signal_chain.h"

namespace echocine::fit {

RenderedBeats::RenderedBeats(Scene scene, int frames) : scene_(std::move(scene)), frames_(frames) {
  scene_.acquisition.frame_rate_hz = frames * scene_.acquisition.heart_rate_hz;
  scene_.acquisition.beats = 1;
  // Pixels of about 0.5 mm.
  scene_.output.width = 360;
  scene_.output.height = 300;
  scene_.output.ecg = scene_.output.depth_ticks = false;
}

RenderedBeats::RenderedBeats(Scene scene, int frames, const RenderedBeats& other)
    : RenderedBeats(std::move(scene), frames) {
  motion_ = other.first_->sharedMotion();
  field_ = other.first_->sharedSpeckle()->field();
}

RenderedBeats::RenderedBeats(RenderedBeats&& other) noexcept = default;
RenderedBeats::~RenderedBeats() = default;

echo::EchoLoop RenderedBeats::loop(int seed) {
  Scene scene = first_ ? first_->scene() : scene_;
  scene.speckle.seed = scene.speckle.heterogeneity_seed = seed;
  scene.artefacts.noise_seed = scene.artefacts.clutter_seed = seed;
  std::unique_ptr<const Simulator> made =
      first_    ? std::make_unique<const Simulator>(scene, *first_)
      : motion_ ? std::make_unique<const Simulator>(scene, motion_, field_)
                : std::make_unique<const Simulator>(scene);
  const Simulator& simulator = *made;
  const Probe& p = simulator.scene().probe;
  const PictureGeometry& g = simulator.chain().geometry();
  echo::EchoLoop loop;
  loop.video.name = "rendered beat";
  loop.video.width = scene.output.width;
  loop.video.height = scene.output.height;
  loop.video.rate = {scene.acquisition.frame_rate_hz, "own", true};
  loop.metres_per_pixel = g.metres_per_pixel;
  loop.frames_per_beat = frames_;
  loop.find.sector = {g.origin_x_px,
                      g.origin_y_px,
                      p.first_angle_rad,
                      p.last_angle_rad,
                      (p.face_radius_m + p.min_depth_m) / g.metres_per_pixel,
                      (p.face_radius_m + p.max_depth_m) / g.metres_per_pixel};
  loop.video.frames.resize(static_cast<std::size_t>(frames_));
  simulator.referenceIntensity();
  parallelBlocks(loop.video.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      loop.video.frames[i] =
          simulator.frame(static_cast<double>(i) / scene.acquisition.frame_rate_hz).image.pixels;
  });
  if (!first_) first_ = std::move(made);
  loop.overlay.assign(loop.video.frames.front().size(), 0);
  loop.video.coloured.assign(loop.overlay.size(), 0);
  return loop;
}

OwnHeart::OwnHeart(const std::map<std::string, double>& dials, heart::View view,
                   const PlaneTilt& tilt, int frames)
    : parameters_(heart::parametersFrom(dials)),
      view_(view),
      tilt_(tilt),
      frames_(frames),
      recording_(std::make_unique<const heart::Recording>(
          heart::heartRecording(parameters_, view, frames))) {}

OwnHeart::OwnHeart(OwnHeart&& other) noexcept = default;
OwnHeart::~OwnHeart() = default;

RenderedBeats OwnHeart::beats(Look look, std::optional<double> persistence,
                              const RenderedBeats* other) const {
  Scene scene = heart::sceneOf(view_, parameters_, *recording_, look);
  // Half of both changes D with own look by less than its noise. Our choice.
  scene.probe.lines /= 2;
  scene.probe.samples /= 2;
  scene.artefacts.persistence = persistence.value_or(scene.artefacts.persistence);
  scene.probe.pose = turnedAndTilted(scene.probe.pose, tilt_.rotate_rad, tilt_.tilt_rad);
  if (other) return {std::move(scene), frames_, *other};
  return {std::move(scene), frames_};
}

}  // namespace echocine::fit
