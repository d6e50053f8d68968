#include "truth/frame_truth.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "motion/interior_motion.h"
#include "scene/effect_plan.h"

namespace echocine {

namespace {

bool wantsAny(const Scene& scene, bool (*kind)(Channel)) {
  return std::any_of(kTruthChannels.begin(), kTruthChannels.end(),
                     [&](Channel c) { return kind(c) && wants(scene, c); });
}

bool isVelocity(Channel channel) {
  return channel >= Channel::velocity_lateral;
}

}  // namespace

// What a frame's truth is made in, used again from frame to frame.
struct TruthMaker::Space {
  explicit Space(const MeshMotion& motion, const Probe& probe) : slice(motion.surfaces(), probe) {}
  SurfaceFrame surfaces;
  PlaneSlice slice;
  FieldFrame now, before, after;
};

std::span<const float> FrameTruth::values(Channel channel) const {
  const auto first =
      isVelocity(channel) ? Channel::velocity_lateral : Channel::displacement_lateral;
  const auto axis = static_cast<std::size_t>(channel) - static_cast<std::size_t>(first);
  return isVelocity(channel) ? motion.velocity_mm_s[axis] : motion.displacement_mm[axis];
}

bool TruthMaker::wanted(const Scene& scene) {
  return scene.truth.any() || wantsAny(scene, isTruth);
}

TruthMaker::TruthMaker(const Scene& scene, const MeshMotion& motion, const PictureGrid& grid,
                       double first_phase)
    : scene_(scene),
      motion_(motion),
      labels_(labelTable(scene)),
      plane_(scene, grid),
      samples_(wantsAny(scene, isTruth)),
      motion_wanted_(wantsAny(scene, isMotion)),
      velocity_(wantsAny(scene, isVelocity)) {
  if (!motion_wanted_ && !scene.truth.tracks && !scene.truth.function) return;
  field_.emplace(interiorMotion(scene, motion));
  field_->at(first_phase, first_);
  if (!scene.truth.tracks && !scene.truth.function) return;
  function_.emplace(scene, motion, *field_, first_phase);
  if (scene.truth.tracks) chooseTracks();
  if (scene.truth.function) lookAtBeat();
}

TruthMaker::~TruthMaker() = default;

void TruthMaker::chooseTracks() {
  const std::vector<WallColumn>& columns = function_->columns();
  std::vector<std::uint32_t> nearest(columns.size());
  for (std::uint32_t i = 0; i < nearest.size(); ++i) nearest[i] = i;
  std::stable_sort(nearest.begin(), nearest.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::abs(columns[a].mid_m.y) < std::abs(columns[b].mid_m.y);
  });
  const auto wanted = static_cast<std::size_t>(scene_.truth.track_count);
  for (const std::uint32_t i : nearest)
    for (std::uint8_t layer = 0; layer < 3 && tracked_.size() < wanted; ++layer)
      tracked_.push_back({layer, static_cast<std::uint8_t>(columns[i].segment), i});
}

// Volumes at 256 phases: 4 ms at 60 beats a minute, less between them.
void TruthMaker::lookAtBeat() {
  constexpr int kSteps = 256;
  const SurfaceTopology& cavity = motion_.surfaces()[index(function_->cavity())];
  SurfaceFrame surfaces;
  std::vector<double> volume_ml;
  for (int i = 0; i < kSteps; ++i) {
    motion_.frameAt(static_cast<double>(i) / kSteps, surfaces, false);
    volume_ml.push_back(millilitresFromCubicMetres(motion_.volumeIn(surfaces, cavity)));
  }
  valves_ = valveTimes(volume_ml);
  if (valves_ && scene_.motion.end_systole_phase)
    valves_->aortic_closes = *scene_.motion.end_systole_phase;
  motion_.frameAt(field_->referencePhase(), surfaces, false);
  view_ = viewOffset(function_->landmarks(surfaces), cavity,
                     surfaces.positions_m[index(function_->cavity())]);
}

void TruthMaker::addTracks(const Space& space, FrameTruth& truth) const {
  const GroupFrame& wall = space.now[field_->groupOf(function_->wall())];
  for (const Tracked& point : tracked_) {
    const WallColumn& column = function_->columns()[point.column];
    truth.tracks_m.push_back(
        point.layer == 0 ? space.surfaces.positions_m[index(function_->cavity())][column.vertex]
                         : wall.place(point.layer == 1 ? column.mid_m : column.epi_m));
  }
}

std::shared_ptr<TruthMaker::Space> TruthMaker::space() const {
  std::unique_ptr<Space> space;
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      space = std::move(free_.back());
      free_.pop_back();
    }
  }
  if (!space) space = std::make_unique<Space>(motion_, scene_.probe);
  return {space.release(), [this](Space* used) {
            const std::lock_guard lock(mutex_);
            free_.emplace_back(used);
          }};
}

// Only slabs that the imaging plane can show are blended.
void TruthMaker::addMotion(const TruthTime& time, Space& space, FrameTruth& truth) const {
  const auto reach_m = static_cast<float>(field_->reachAcrossPlane() + 2 * field_->spacing());
  const std::pair slab(-reach_m, reach_m);
  field_->at(time.phase, space.now, slab);
  if (velocity_) {
    field_->at(time.before, space.before, slab);
    field_->at(time.after, space.after, slab);
  }
  const FieldTimes times{first_, space.now, velocity_ ? space.before : space.now,
                         velocity_ ? space.after : space.now, velocity_ ? time.seconds : 1};
  motionPlanes(scene_, *field_, times, truth.sample_ids, velocity_, truth.motion);
}

FrameTruth TruthMaker::at(const TruthTime& time) const {
  FrameTruth truth;
  const std::shared_ptr<Space> s = space();
  motion_.frameAt(time.phase, s->surfaces);
  s->slice.update(s->surfaces);
  if (scene_.truth.labels) {
    plane_.picture(s->slice.edges(), truth.picture_ids);
    truth.labels.reserve(truth.picture_ids.size());
    for (const std::uint16_t id : truth.picture_ids)
      truth.labels.push_back(id == 0 ? std::uint8_t{0} : labels_.numbers[id - 1u]);
  }
  if (samples_) plane_.samples(s->slice.lines(), truth.sample_ids);
  if (scene_.truth.contours)
    truth.contours = chainContours(s->slice.edges(), motion_.surfaces(), s->surfaces);
  if (function_) field_->at(time.phase, s->now);
  if (scene_.truth.function) truth.function = function_->at(s->surfaces, s->now);
  if (scene_.truth.tracks) addTracks(*s, truth);
  if (motion_wanted_) addMotion(time, *s, truth);
  return truth;
}

}  // namespace echocine
