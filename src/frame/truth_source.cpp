#include "frame/truth_source.h"

#include <algorithm>

#include "frame/loop_instant.h"
#include "frame/picture_grid.h"
#include "plan/effect_plan.h"
#include "scene/role.h"
#include "trace/sound_path_tracer.h"
#include "truth/visible_border.h"

namespace echocine {

namespace {

bool wantsVisible(const Scene& scene, SurfaceId surface) {
  const std::vector<Role>& roles = scene.truth.visible_roles;
  return roles.empty() ||
         std::ranges::find(roles, roleOf(scene.structures[index(surface)])) != roles.end();
}

}  // namespace

TruthSource::TruthSource(const Scene& scene, const MeshMotion& motion,
                         const SharedMotionField& field, const CardiacClock& clock,
                         const LoopPlan& plan, const RollingLines* rolling, bool as_traced)
    : scene_(scene),
      motion_(motion),
      field_(field),
      clock_(clock),
      rolling_(rolling),
      as_traced_(as_traced),
      normals_(plan.smooth_normals) {
  if (plan.effects.refraction || plan.effects.travel_time)
    bent_.emplace(soundPathSettings(scene, plan.effects));
}

const TruthMaker* TruthSource::maker() const {
  std::call_once(once_, [this] {
    if (TruthMaker::wanted(scene_))
      maker_ = std::make_unique<const TruthMaker>(scene_, motion_, pictureGrid(scene_),
                                                  clock_.at(0).phase, bent_.has_value(), &field_);
  });
  return maker_.get();
}

// Velocity is taken from a millisecond before to one after, within the loop; rolling lines may
// begin a little before it and end a little after it.
FrameTruth TruthSource::ofInstant(const FrameTime& time, TruthShared shared,
                                  bool planes_only) const {
  std::shared_ptr<PathSpace> space;
  if (bent_) {
    space = pathSpace();
    addPaths(time.phase, *space, shared);
  }
  constexpr double kStep_s = 1e-3;
  const double end_s = clock_.frameCount() / scene_.acquisition.frame_rate_hz;
  const double before_s = std::max(time.time_s - kStep_s, std::min(time.time_s, 0.0)),
               after_s = std::min(time.time_s + kStep_s, std::max(time.time_s, end_s));
  return maker()->at({time.phase, clock_.atTime(before_s).phase, clock_.atTime(after_s).phase,
                      after_s - before_s, planes_only},
                     shared);
}

std::shared_ptr<TruthSource::PathSpace> TruthSource::pathSpace() const {
  return spaces_.borrow([this] {
    return std::make_unique<PathSpace>(PathSpace{
        {}, FrameGeometry(motion_.surfaces()), TruthMaker::pathsFor(scene_, pictureGrid(scene_))});
  });
}

// Traced surfaces serve where they are there.
void TruthSource::addPaths(double phase, PathSpace& space, TruthShared& shared) const {
  if (shared.surfaces == nullptr) {
    motion_.frameAt(phase, space.surfaces, normals_);
    shared.surfaces = &space.surfaces;
  }
  space.geometry.update(*shared.surfaces);
  traceSoundPaths(space.geometry, *bent_, space.paths);
  shared.paths = &space.paths;
}

// With rolling lines, values at samples and pixels are those of each line's instant; the others are
// those of the frame's time.
FrameTruth TruthSource::at(const FrameTime& time, const Workspace* traced) const {
  TruthShared shared;
  if (traced != nullptr && traced->phase == time.phase) {
    shared.surfaces = &traced->surfaces;
    if (as_traced_) shared.slice = std::get_if<PlaneSlice>(&traced->geometry);
  }
  FrameTruth truth = ofInstant(time, shared, false);
  for (std::size_t g = 0; rolling_ && g < rolling_->groups().size(); ++g) {
    const double offset_s = rolling_->groups()[g].offset_s;
    const FrameTime instant = instantOf(clock_, scene_, time.time_s + offset_s);
    rolling_->take(g, ofInstant(instant, {}, true), truth);
  }
  const auto samples =
      static_cast<std::size_t>(scene_.probe.lines) * static_cast<std::size_t>(scene_.probe.samples);
  if (traced != nullptr && wantsPicture(scene_) && traced->greys.size() == samples)
    for (Contour& contour : truth.contours)
      if (wantsVisible(scene_, contour.surface))
        contour.visible =
            visiblePoints(contour, scene_.structures[index(contour.surface)].membrane, scene_.probe,
                          traced->greys, scene_.signal.dynamic_range_db);
  return truth;
}

}  // namespace echocine
