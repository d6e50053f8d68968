#include "speckle/field_material.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/box.h"
#include "core/nearest_vertex.h"
#include "plan/media_in_use.h"
#include "scene/role.h"

namespace echocine {

namespace {

// Lung's renewal time, of that of the surroundings. Lung shows no tissue of its own but multiple
// reflections of moving tissue, so its grain changes faster. Our choice.
constexpr float kLungTime = 0.4f;

constexpr float kStillBlock_m = 8e-3f;  // where nothing moves
constexpr float kBehind_m = 1e-3f;      // of a ridge's foot, in the wall. Our choice
constexpr int kPhasesLookedAt = 32;
constexpr double kBetweenPhases = 1.1;  // tissue may move farther between them

}  // namespace

// A ventricle's relief at the reference phase.
struct FieldMaterial::Ridges {
  GroupId cavity;
  NearestVertex surface;
  std::vector<Vec3f> at_m, outward;  // by vertex; outward are unit
  std::vector<float> height_m;
  float reach_m;  // no place in a ridge is farther from the nearest vertex

  Ridges(const Relief& relief, const SurfaceTopology& topology, std::vector<Vec3f> vertices_m,
         GroupId group)
      : cavity(group),
        surface(vertices_m),
        at_m(std::move(vertices_m)),
        outward(at_m.size()),
        height_m(relief.height_m),
        reach_m(std::max(*std::max_element(height_m.begin(), height_m.end()), 0.0f)) {
    float longest_m = 0;
    for (const Triangle& t : topology.triangles) {
      longest_m = std::max(longest_m, length(at_m[t[1]] - at_m[t[0]]));
      const Vec3f n = cross(at_m[t[1]] - at_m[t[0]], at_m[t[2]] - at_m[t[0]]);
      for (const std::uint32_t v : t) outward[v] = outward[v] + n;
    }
    for (Vec3f& n : outward)
      if (dot(n, n) > 0) n = normalised(n);
    reach_m = std::hypot(reach_m, longest_m);
  }

  // False only where no place in the box is in a ridge.
  bool reachInto(const Box& box) const {
    const double radius_m = 0.5 * length(box.hi - box.lo);
    return surface
        .numberOf(toFloat(0.5 * (box.lo + box.hi)), static_cast<float>(radius_m) + reach_m)
        .has_value();
  }

  // Behind the surface where a place is in a ridge, else nothing.
  std::optional<Vec3f> behind(Vec3f place_m) const {
    const std::optional<std::uint32_t> v = surface.numberOf(place_m, reach_m);
    if (!v) return std::nullopt;
    const float depth_m = -dot(place_m - at_m[*v], outward[*v]);
    if (!(depth_m < height_m[*v])) return std::nullopt;
    return place_m + (std::max(depth_m, 0.0f) + kBehind_m) * outward[*v];
  }
};

FieldMaterial::~FieldMaterial() = default;

FieldMaterial::FieldMaterial(const Scene& scene, const MeshMotion& motion, const EffectPlan* plan,
                             const Trabeculae* trabeculae, const SharedMotionField* shared)
    : field_((shared ? *shared : own_field_.emplace(scene, motion)).field()) {
  if (plan && (plan->heterogeneity || plan->anisotropy))
    strength_ = std::make_unique<const TissueStrength>(scene, *plan, motion, field_);
  const std::size_t groups = field_.groupCount();
  blood_.assign(groups, false);
  blood_.back() = scene.medium(scene.background).blood;
  surroundings_.assign(groups, 0);
  surroundings_.back() = 1;
  for (const SurfaceTopology& surface : motion.surfaces())
    if (!surface.membrane) {
      const Structure& structure = scene.structures[index(surface.id)];
      const std::size_t group = index(field_.groupOf(surface.id));
      blood_[group] = scene.medium(structure.medium).blood;
      if (surface.still && roleOf(structure) == Role::surroundings)
        surroundings_[group] = isAirFilled(scene.medium(structure.medium)) ? kLungTime : 1;
    }
  if (trabeculae) {
    SurfaceFrame surfaces;
    for (const Relief& relief : trabeculae->reliefs()) {
      motion.positionsAt(field_.referencePhase(), {&relief.surface, 1}, surfaces);
      ridges_.emplace_back(relief, motion.surfaces()[index(relief.surface)],
                           surfaces.positions_m[index(relief.surface)],
                           field_.groupOf(relief.surface));
    }
  }
  reach_ = BlockReach(field_, kPhasesLookedAt);
  along_m_ = kBetweenPhases * reach_.alongPlane();
  across_m_ = kBetweenPhases * field_.reachAcrossPlane();
  const float fine_m = static_cast<float>(field_.spacing());
  lattice_.block_m = fine_m > 0 ? 2 * fine_m : kStillBlock_m;
  FieldFrame frame;
  field_.at(0, frame);
  // Blocks are the cells of the coarse lattice where there is one, else pairs of the fine one's.
  float coarsest_m = 0;
  for (const GroupFrame& group : frame.groups)
    if (!group.grid.empty() && group.grid.spacing_m > coarsest_m) {
      coarsest_m = group.grid.spacing_m;
      lattice_.origin_m = group.grid.origin_m;
    }
  for (const GroupFrame& group : frame.groups)
    coarse_.push_back(group.grid.empty() || group.grid.spacing_m > 0.99f * lattice_.block_m);
}

void FieldMaterial::overTheBeat(const std::function<void(const MaterialFrame&)>& look) const {
  FieldFrame frame;
  for (int i = 0; i < kPhasesLookedAt; ++i) {
    field_.at(static_cast<double>(i) / kPhasesLookedAt, frame);
    look(FieldMaterialFrame(frame));
  }
}

// A place in a ridge of a cavity belongs to the wall behind it.
std::vector<std::uint16_t> FieldMaterial::groupsIn(Vec3f low_m) const {
  constexpr double kRounding_m = 1e-6;
  const double edge_m = static_cast<double>(lattice_.block_m) + kRounding_m;
  const Vec3d low = toDouble(low_m);
  const Box block{low - kRounding_m * Vec3d{1, 1, 1}, low + edge_m * Vec3d{1, 1, 1}};
  std::vector<GroupId> ids = field_.groupsIn(block);
  const auto has = [&](GroupId id) { return std::ranges::find(ids, id) != ids.end(); };
  for (const Ridges& ridges : ridges_) {
    if (!has(ridges.cavity)) continue;
    const Vec3d behind = static_cast<double>(ridges.reach_m + kBehind_m) * Vec3d{1, 1, 1};
    for (const GroupId wall : field_.groupsIn({block.lo - behind, block.hi + behind}))
      if (!blood_[index(wall)] && !has(wall)) ids.push_back(wall);
  }
  std::vector<std::uint16_t> groups;
  for (const GroupId id : ids) groups.push_back(static_cast<std::uint16_t>(index(id)));
  return groups;
}

void FieldMaterial::groupsAt(std::span<const Vec3f> reference_m,
                             std::span<std::uint16_t> groups) const {
  std::vector<GroupId> ids(reference_m.size());
  field_.groupsAt(reference_m, ids);
  Box about;
  for (const Vec3f p : reference_m) about.add(toDouble(p));
  for (const Ridges& ridges : ridges_) {
    if (!ridges.reachInto(about)) continue;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] != ridges.cavity) continue;
      const std::optional<Vec3f> behind_m = ridges.behind(reference_m[i]);
      if (!behind_m) continue;
      const GroupId wall = field_.groupAt(*behind_m);
      if (!blood_[index(wall)]) ids[i] = wall;
    }
  }
  std::transform(ids.begin(), ids.end(), groups.begin(),
                 [](GroupId id) { return static_cast<std::uint16_t>(index(id)); });
}

CubeCorners FieldMaterialFrame::corners(std::uint16_t group, Vec3f low_m, float edge_m) const {
  const GroupFrame& frame = frame_.groups[group];
  CubeCorners corners;
  for (std::size_t c = 0; c < corners.size(); ++c)
    corners[c] = low_m + edge_m * Vec3f{c & 1 ? 1.0f : 0, c & 2 ? 1.0f : 0, c & 4 ? 1.0f : 0};
  if (frame.displacement_m.empty()) return corners;
  const LatticeGrid& grid = frame.grid;
  const float per_m = 1 / grid.spacing_m;
  const auto node = [&](float at_m) { return static_cast<int>(at_m * per_m + 0.5f); };
  const Vec3f from = low_m - grid.origin_m;
  const int ix = node(from.x), iy = node(from.y), iz = node(from.z);
  const bool cell = edge_m > 0.99f * grid.spacing_m && from.x > -0.1f * edge_m &&
                    from.y > -0.1f * edge_m && from.z > -0.1f * edge_m && ix + 1 < grid.nx &&
                    iy + 1 < grid.ny && iz + 1 < grid.nz;
  if (!cell) {
    for (Vec3f& corner : corners) corner = frame.place(corner);
    return corners;
  }
  const std::size_t first = grid.at(ix, iy, iz), row = static_cast<std::size_t>(grid.nx),
                    slab = row * static_cast<std::size_t>(grid.nz);
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::size_t at = first + (c & 1) + (c & 2 ? slab : 0) + (c & 4 ? row : 0);
    corners[c] = corners[c] + frame.displacement_m[at];
  }
  return corners;
}

}  // namespace echocine
