#include "truth/frame_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "motion/surfaces/interior_motion.h"
#include "plan/effect_plan.h"
#include "truth/shown_contours.h"

namespace echocine {

namespace {

bool wantsAny(const Scene& scene, bool (*kind)(Channel)) {
  return std::any_of(kTruthChannels.begin(), kTruthChannels.end(),
                     [&](Channel c) { return kind(c) && wants(scene, c); });
}

constexpr float kFarAway = 1e9f;

// Tracks and landmarks, from where the heart has them to where the picture shows them.
void showPlaces(const SoundPaths& paths, FrameTruth& truth) {
  for (Vec3f& p : truth.tracks_m) p = toFloat(paths.shown(toDouble(p)));
  if (!truth.function) return;
  FunctionFrame& f = *truth.function;
  for (Vec3d* const p : {&f.axis.base_m, &f.axis.apex_m}) *p = paths.shown(*p);
  for (auto* const ring : {&f.mitral, &f.tricuspid, &f.aortic}) {
    if (!*ring) continue;
    (*ring)->middle_m = paths.shown((*ring)->middle_m);
    if (!(*ring)->hinges_m) continue;
    for (Vec3d* const p : {&(*ring)->hinges_m->first, &(*ring)->hinges_m->second})
      *p = paths.shown(*p);
  }
}

}  // namespace

// Working memory for a frame's truth, reused from frame to frame.
struct TruthMaker::Space {
  explicit Space(const MeshMotion& motion, const Probe& probe) : slice(motion.surfaces(), probe) {}
  SurfaceFrame surfaces;
  PlaneSlice slice;
  FieldFrame now, before, after;
};

std::span<const float> FrameTruth::values(Channel channel) const {
  if (channel == Channel::velocity_beam) return motion.beam_m_s;
  const auto first =
      isVelocity(channel) ? Channel::velocity_lateral : Channel::displacement_lateral;
  const auto axis = static_cast<std::size_t>(channel) - static_cast<std::size_t>(first);
  return isVelocity(channel) ? motion.velocity_mm_s[axis] : motion.displacement_mm[axis];
}

SoundPaths TruthMaker::pathsFor(const Scene& scene, const PictureGrid& grid) {
  constexpr double kAnyDistance_m = 1e9;  // samples stand on the scene's own lines
  return emptyPaths(scene.probe, scene.truth.any() ? 0.5 * grid.metres_per_pixel : kAnyDistance_m);
}

bool TruthMaker::wanted(const Scene& scene) {
  return scene.truth.any() || wantsAny(scene, isTruth);
}

TruthMaker::TruthMaker(const Scene& scene, const MeshMotion& motion, const PictureGrid& grid,
                       double first_phase, bool along_paths, const SharedMotionField* shared)
    : scene_(scene),
      motion_(motion),
      labels_(labelTable(scene)),
      plane_(scene, grid),
      samples_(wantsAny(scene, isTruth)),
      motion_wanted_(wantsAny(scene, isMotion)),
      velocity_(wantsAny(scene, isVelocity)) {
  if (along_paths) shown_.emplace(scene, grid, pathsFor(scene, grid));
  if (!motion_wanted_ && !scene.truth.tracks && !scene.truth.function) return;
  if (shared == nullptr) shared = &own_field_.emplace(scene, motion);
  field_ = &shared->field();
  field_->at(first_phase, first_);
  in_plane_ = tissueInPlane();
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
  std::pair<float, float> y_m{kFarAway, -kFarAway};
  for (const Tracked& point : tracked_)
    for (const Vec3f p : {columns[point.column].mid_m, columns[point.column].epi_m})
      y_m = {std::min(y_m.first, p.y), std::max(y_m.second, p.y)};
  about_tracks_.resize(field_->groupCount());
  about_tracks_[index(field_->groupOf(function_->wall()))] = y_m;
  const auto seen = [&](const Tracked& point) {
    const Vec3d p = toDouble(columns[point.column].mid_m);
    return inScanArea(scene_.probe, p.x, p.z);
  };
  if (!std::any_of(tracked_.begin(), tracked_.end(), seen))
    throw SceneError(atPlace(
        scene_.truth.tracks_place,
        fmt::format("no material point of {} is within the sector: aim the probe at it, or leave "
                    "tracks out of truth.write",
                    scene_.structures[index(function_->wall())].name)));
}

// Volumes at 256 phases: 4 ms at 60 beats a minute, less between them.
void TruthMaker::lookAtBeat() {
  constexpr int kSteps = 256;
  const SurfaceTopology& cavity = motion_.surfaces()[index(function_->cavity())];
  SurfaceFrame surfaces;
  std::vector<double> volume_ml;
  for (int i = 0; i < kSteps; ++i) {
    motion_.positionsAt(static_cast<double>(i) / kSteps, {&cavity.id, 1}, surfaces);
    volume_ml.push_back(millilitresFromCubicMetres(motion_.volumeIn(surfaces, cavity)));
  }
  valves_ = valveTimes(volume_ml);
  if (valves_ && scene_.motion.end_systole_phase)
    valves_->aortic_closes = *scene_.motion.end_systole_phase;
  view_ = viewOffset(scene_, motion_);
}

void TruthMaker::addTracks(const SurfaceFrame& surfaces, const Space& space,
                           FrameTruth& truth) const {
  const GroupFrame& wall = space.now[field_->groupOf(function_->wall())];
  for (const Tracked& point : tracked_) {
    const WallColumn& column = function_->columns()[point.column];
    truth.tracks_m.push_back(point.layer == 0
                                 ? surfaces.positions_m[index(function_->cavity())][column.vertex]
                                 : wall.place(point.layer == 1 ? column.mid_m : column.epi_m));
  }
}

std::shared_ptr<TruthMaker::Space> TruthMaker::space() const {
  return spaces_.borrow([this] { return std::make_unique<Space>(motion_, scene_.probe); });
}

// Only what the imaging plane can show of tissue is blended.
FieldPart TruthMaker::tissueInPlane() const {
  const std::vector<bool> tissue = tissueGroups(scene_, *field_);
  FieldPart part(tissue.size());
  for (std::size_t g = 0; g < part.size(); ++g) {
    if (!tissue[g]) continue;
    const double reach_m =
        field_->reachAcrossPlane(static_cast<GroupId>(g)) + 2 * field_->spacing();
    part[g].emplace(static_cast<float>(-reach_m), static_cast<float>(reach_m));
  }
  return part;
}

// Bent paths leave the imaging plane.
FieldPart TruthMaker::partAround(const SoundPaths* paths) const {
  FieldPart part = in_plane_;
  if (paths == nullptr) return part;
  float off_m = 0;
  for (const SoundPath& path : paths->paths)
    for (const SoundPath::Knot& knot : path.knots)
      off_m = std::max(off_m, static_cast<float>(std::abs(knot.place_m.y)));
  for (auto& range : part)
    if (range) range.emplace(range->first - off_m, range->second + off_m);
  return part;
}

void TruthMaker::addMotion(const TruthTime& time, const SoundPaths* paths, Space& space,
                           FrameTruth& truth) const {
  const FieldPart part = partAround(paths);
  field_->at(time.phase, space.now, part);
  if (velocity_) {
    field_->at(time.before, space.before, part);
    field_->at(time.after, space.after, part);
  }
  const bool moved = first_.phase != field_->referencePhase();
  const FieldTimes times{moved ? &first_ : nullptr, space.now, velocity_ ? space.before : space.now,
                         velocity_ ? space.after : space.now, velocity_ ? time.seconds : 1};
  motionPlanes(scene_, *field_, times, truth.sample_ids, velocity_, paths, truth.motion);
}

const PlaneSlice& TruthMaker::sliceOf(const SurfaceFrame& surfaces, const TruthShared& shared,
                                      Space& space) const {
  if (shared.slice != nullptr) return *shared.slice;
  if (samples_)
    space.slice.update(surfaces);
  else
    space.slice.cut(surfaces);
  return space.slice;
}

FrameTruth TruthMaker::at(const TruthTime& time, const TruthShared& shared) const {
  FrameTruth truth;
  TruthSettings wanted = scene_.truth;
  if (time.planes_only) wanted.contours = wanted.function = wanted.tracks = false;
  const std::shared_ptr<Space> s = space();
  if (shared.surfaces == nullptr) motion_.frameAt(time.phase, s->surfaces, false);
  const SurfaceFrame& surfaces = shared.surfaces != nullptr ? *shared.surfaces : s->surfaces;
  addPlanes(surfaces, wanted, shared, *s, truth);
  if (wanted.function) {
    field_->at(time.phase, s->now);
    truth.function = function_->at(surfaces, s->now);
  } else if (wanted.tracks) {
    field_->at(time.phase, s->now, about_tracks_);
  }
  if (wanted.tracks) addTracks(surfaces, *s, truth);
  if (shared.paths != nullptr) showPlaces(*shared.paths, truth);
  if (motion_wanted_) addMotion(time, shared.paths, *s, truth);
  return truth;
}

void TruthMaker::addPlanes(const SurfaceFrame& surfaces, const TruthSettings& wanted,
                           const TruthShared& shared, Space& space, FrameTruth& truth) const {
  if (!wanted.labels && !wanted.contours && !samples_) return;
  if (shared.paths != nullptr) {
    if (wanted.labels) shown_->picture(*shared.paths, truth.picture_ids);
    if (samples_) shown_->samples(*shared.paths, truth.sample_ids);
    if (wanted.contours) truth.contours = shownContours(scene_, *shared.paths);
  } else {
    const PlaneSlice& slice = sliceOf(surfaces, shared, space);
    if (wanted.labels) plane_.picture(slice.edges(), truth.picture_ids);
    if (samples_) plane_.samples(slice.lines(), truth.sample_ids);
    if (wanted.contours)
      truth.contours = chainContours(slice.edges(), motion_.surfaces(), surfaces);
  }
  if (wanted.labels) numberLabels(truth);
}

void TruthMaker::numberLabels(FrameTruth& truth) const {
  std::vector<std::uint8_t> number_of{0};
  number_of.insert(number_of.end(), labels_.numbers.begin(), labels_.numbers.end());
  truth.labels.resize(truth.picture_ids.size());
  std::transform(truth.picture_ids.begin(), truth.picture_ids.end(), truth.labels.begin(),
                 [&](std::uint16_t id) { return number_of[id]; });
}

}  // namespace echocine
