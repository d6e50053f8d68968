#include "motion/interior/motion_field.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "core/check.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "motion/interior/group_lattice.h"
#include "motion/interior/lattice_slabs.h"
#include "motion/interior/reach_across.h"
#include "motion/interior/top_surfaces_at.h"

namespace echocine {

namespace {

// Our choices, measured in tests/laws: the margin in spacings, and the modes' tolerance in parts of
// the moving surfaces' diagonal.
constexpr double kMarginSpacings = 10, kModeTolerance = 3e-6;

// The surface's vertices at a phase; exactly those of a keyframe where it is one.
std::vector<Vec3f> positionsAt(const InteriorSurface& surface, double phase) {
  std::vector<double> weights(surface.weights.keyframeCount());
  surface.weights.at(phase, weights);
  if (const auto k = std::find(weights.begin(), weights.end(), 1.0); k != weights.end())
    return surface.keyframes_m[static_cast<std::size_t>(k - weights.begin())];
  std::vector<Vec3f> positions(surface.keyframes_m.front().size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    Vec3d sum;
    for (std::size_t k = 0; k < weights.size(); ++k)
      sum = sum + weights[k] * toDouble(surface.keyframes_m[k][v]);
    positions[v] = toFloat(sum);
  }
  return positions;
}

bool samePhases(const KeyframeWeights& a, const KeyframeWeights& b) {
  return std::equal(a.phases().begin(), a.phases().end(), b.phases().begin(), b.phases().end());
}

std::uint64_t nextNumber() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

}  // namespace

struct MotionField::State {
  struct Group {
    GroupMembers members;
    GroupLattice lattice;
    double reach_across_m = 0;
  };
  const std::uint64_t field_number = nextNumber();
  FieldSettings settings;
  FieldSpace space{};
  std::unique_ptr<TopSurfaces> tops;
  std::vector<std::uint32_t> group_of;  // by surface
  std::vector<Group> groups;
  std::vector<PhaseClass> classes;

  void number(const std::vector<InteriorSurface>& surfaces);
  std::vector<std::int32_t> classify(const std::vector<InteriorSurface>& surfaces);
  bool measure(const std::vector<InteriorSurface>& surfaces,
               std::span<const std::vector<Vec3f>> reference_m);
  void findModes(const std::vector<InteriorSurface>& surfaces,
                 std::span<const std::int32_t> class_of, std::span<const BorderPoint> points);
  void fit(std::span<const BorderPoint> points);
};

// Groups in the order of their first surface; the background is the last.
void MotionField::State::number(const std::vector<InteriorSurface>& surfaces) {
  const auto background = static_cast<std::uint32_t>(surfaces.size());
  group_of.assign(surfaces.size(), background);
  for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
    if (surfaces[s].membrane) continue;
    const auto same = [&](const Group& group) {
      return surfaces[s].group >= 0 &&
             surfaces[group.members.surfaces.front()].group == surfaces[s].group;
    };
    auto found = std::find_if(groups.begin(), groups.end(), same);
    if (found == groups.end()) found = groups.insert(found, Group{{{}, true}, {}, 0});
    found->members.surfaces.push_back(s);
    found->members.open &= surfaces[s].weights.keyframeCount() == 1;
    group_of[s] = static_cast<std::uint32_t>(found - groups.begin());
  }
  groups.push_back({{{background}, true, true}, {}, 0});
  for (std::uint32_t& group : group_of)
    group = std::min(group, static_cast<std::uint32_t>(groups.size() - 1));
}

// The class of each closed surface that moves, else -1.
std::vector<std::int32_t> MotionField::State::classify(
    const std::vector<InteriorSurface>& surfaces) {
  std::vector<std::int32_t> class_of;
  for (const InteriorSurface& surface : surfaces) {
    class_of.push_back(-1);
    if (surface.membrane || surface.weights.keyframeCount() == 1) continue;
    auto found = std::find_if(classes.begin(), classes.end(), [&](const PhaseClass& c) {
      return samePhases(c.weights, surface.weights);
    });
    if (found == classes.end()) found = classes.insert(found, {surface.weights, {}, {}});
    class_of.back() = static_cast<std::int32_t>(found - classes.begin());
  }
  return class_of;
}

// The space about what moves; false when nothing does.
bool MotionField::State::measure(const std::vector<InteriorSurface>& surfaces,
                                 std::span<const std::vector<Vec3f>> reference_m) {
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    if (!surfaces[s].membrane && surfaces[s].weights.keyframeCount() > 1)
      for (const Vec3f p : reference_m[s]) space.moving.add(toDouble(p));
  if (!(space.moving.hi.x >= space.moving.lo.x)) return false;
  const double diagonal_m = length(space.moving.hi - space.moving.lo);
  space.spacing_m = diagonal_m / settings.cells;
  space.margin_m = kMarginSpacings * space.spacing_m;
  if (settings.beyond_m > space.spacing_m)
    space.cells_beyond = static_cast<int>(std::ceil(settings.beyond_m / space.spacing_m));
  return space.spacing_m > 0;
}

void MotionField::State::findModes(const std::vector<InteriorSurface>& surfaces,
                                   std::span<const std::int32_t> class_of,
                                   std::span<const BorderPoint> points) {
  const double tolerance_m = kModeTolerance * length(space.moving.hi - space.moving.lo);
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const std::size_t keyframes = classes[c].weights.keyframeCount();
    std::vector<Vec3f> displacement_m;
    std::int32_t count = 0;
    checkpoint();
    for (const BorderPoint& point : points) {
      const std::size_t s = index(point.surface);
      const bool mine = class_of[s] == static_cast<std::int32_t>(c);
      classes[c].order.push_back(mine ? count++ : -1);
      if (!mine) continue;
      for (std::size_t k = 0; k < keyframes; ++k)
        displacement_m.push_back(placeOf(point, surfaces[s].keyframes_m[k]) - point.reference_m);
    }
    checkpoint();
    classes[c].modes = motionModes(displacement_m, keyframes, tolerance_m);
  }
}

// Groups with many points take longest and are begun first, so threads end together.
void MotionField::State::fit(std::span<const BorderPoint> points) {
  std::vector<std::size_t> sizes(groups.size(), 0), order(groups.size());
  for (const BorderPoint& point : points) {
    ++sizes[group_of[index(point.surface)]];
    ++sizes[point.beyond < group_of.size() ? group_of[point.beyond] : groups.size() - 1];
  }
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t g) { return sizes[g]; });
  parallelBlocks(groups.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Group& group = groups[order[i]];
      group.lattice = fitGroup(space, group.members, *tops, points, classes);
    }
  });
  for (Group& group : groups) group.reach_across_m = reachAcross(group.lattice, classes);
}

MotionField::MotionField(std::vector<InteriorSurface> surfaces, const FieldSettings& settings)
    : state_(std::make_unique<State>()) {
  State& state = *state_;
  state.settings = settings;
  state.number(surfaces);
  std::vector<std::vector<Vec3f>> reference_m(surfaces.size());
  std::vector<std::optional<Columns>> columns(surfaces.size());
  parallelBlocks(surfaces.size(), 1, [&](std::size_t s, std::size_t) {
    reference_m[s] = positionsAt(surfaces[s], settings.reference_phase);
    if (!surfaces[s].membrane) columns[s].emplace(surfaces[s].triangles, reference_m[s]);
  });
  std::vector<TopSurfaces::Closed> closed;
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    if (columns[s])
      closed.push_back({static_cast<SurfaceId>(s), surfaces[s].priority, std::move(*columns[s])});
  state.tops = std::make_unique<TopSurfaces>(std::move(closed));
  const std::vector<std::int32_t> class_of = state.classify(surfaces);
  if (!state.measure(surfaces, reference_m)) return;
  const double margin_m = state.space.margin_m;
  const Vec3d margin{margin_m, margin_m, margin_m};
  const Box region{state.space.moving.lo - margin, state.space.moving.hi + margin};
  const std::vector<BorderPoint> points =
      borderPoints(surfaces, reference_m, *state.tops, region, state.space.spacing_m);
  state.findModes(surfaces, class_of, points);
  state.fit(points);
}

MotionField::~MotionField() = default;
MotionField::MotionField(MotionField&&) noexcept = default;

std::size_t MotionField::groupCount() const {
  return state_->groups.size();
}
GroupId MotionField::background() const {
  return static_cast<GroupId>(state_->groups.size() - 1);
}
GroupId MotionField::groupOf(SurfaceId surface) const {
  return static_cast<GroupId>(state_->group_of[index(surface)]);
}
bool MotionField::moves(GroupId group) const {
  return !state_->groups[index(group)].lattice.grid.empty();
}
double MotionField::referencePhase() const {
  return state_->settings.reference_phase;
}
double MotionField::spacing() const {
  return state_->space.spacing_m;
}
double MotionField::residual() const {
  double worst = 0;
  for (const State::Group& group : state_->groups) worst = std::max(worst, group.lattice.residual);
  return worst;
}
double MotionField::reachAcrossPlane() const {
  double most_m = 0;
  for (const State::Group& group : state_->groups) most_m = std::max(most_m, group.reach_across_m);
  return most_m;
}
double MotionField::reachAcrossPlane(GroupId group) const {
  return state_->groups[index(group)].reach_across_m;
}

std::optional<SurfaceId> MotionField::surfaceAt(Vec3f reference_m) const {
  return state_->tops->at(toDouble(reference_m));
}

GroupId MotionField::groupAt(Vec3f reference_m) const {
  const auto surface = surfaceAt(reference_m);
  return surface ? groupOf(*surface) : background();
}

void MotionField::groupsAt(std::span<const Vec3f> reference_m, std::span<GroupId> groups) const {
  CHECK_EQ(reference_m.size(), groups.size());
  std::vector<std::optional<SurfaceId>> tops(reference_m.size());
  topSurfacesAt(*state_->tops, reference_m, tops);
  for (std::size_t i = 0; i < tops.size(); ++i)
    groups[i] = tops[i] ? groupOf(*tops[i]) : background();
}

std::vector<GroupId> MotionField::groupsIn(const Box& reference_m) const {
  std::vector<GroupId> groups;
  for (const auto surface : state_->tops->within(reference_m).surfaces()) {
    const GroupId group = surface ? groupOf(*surface) : background();
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }
  return groups;
}

void MotionField::at(double phase, FieldFrame& frame) const {
  constexpr float everywhere_m = std::numeric_limits<float>::infinity();
  at(phase, frame, FieldPart(groupCount(), std::pair(-everywhere_m, everywhere_m)));
}

void MotionField::at(double phase, FieldFrame& frame, const FieldPart& part) const {
  CHECK_EQ(part.size(), groupCount());
  frame.phase = phase;
  // Nodes without a row are never written, so they must be 0 first: frames are reused.
  const bool is_new = frame.field_number != state_->field_number;
  if (is_new) frame.field_number = 0;  // until all groups are set: a stop may leave early
  frame.groups.resize(state_->groups.size());
  thread_local std::vector<std::vector<KeyframeWeights::Term>> terms;
  thread_local std::vector<Vec3f> sums_m;
  terms.resize(state_->classes.size());
  for (std::size_t c = 0; c < terms.size(); ++c)
    state_->classes[c].weights.termsAt(phase, terms[c]);
  for (std::size_t g = 0; g < frame.groups.size(); ++g) {
    checkpoint();
    const GroupLattice& lattice = state_->groups[g].lattice;
    GroupFrame& out = frame.groups[g];
    out.grid = lattice.grid;
    if (is_new) out.displacement_m.assign(lattice.grid.empty() ? 0 : lattice.grid.count(), Vec3f{});
    if (lattice.grid.empty() || !part[g]) continue;
    const auto [begin, end] = nodesWithin(lattice, *part[g]);
    sums_m.assign(end - begin, Vec3f{});
    for (std::size_t c = 0; c < terms.size(); ++c)
      for (const KeyframeWeights::Term& term : terms[c]) {
        const auto weight = static_cast<float>(term.weight);
        const Vec3f* const row_m = lattice.rows_m[c][term.row].data() + begin;
        for (std::size_t i = 0; i < sums_m.size(); ++i) sums_m[i] = sums_m[i] + weight * row_m[i];
      }
    for (std::size_t i = 0; i < sums_m.size(); ++i)
      out.displacement_m[lattice.nodes.nodes[begin + i]] = sums_m[i];
  }
  frame.field_number = state_->field_number;
}

}  // namespace echocine
