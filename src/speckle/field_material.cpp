#include "speckle/field_material.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

constexpr float kStillBlock_m = 8e-3f;  // where nothing moves
constexpr int kPhasesLookedAt = 32;
constexpr double kBetweenPhases = 1.1;  // tissue may move farther between them

}  // namespace

FieldMaterial::FieldMaterial(const Scene& scene, const MeshMotion& motion, const EffectPlan* plan)
    : field_(interiorMotion(scene, motion)) {
  if (plan && (plan->heterogeneity || plan->anisotropy))
    strength_ = std::make_unique<const TissueStrength>(scene, *plan, motion, field_);
  const std::size_t groups = field_.groupCount();
  blood_.assign(groups, false);
  blood_.back() = scene.medium(scene.background).blood;
  for (const SurfaceTopology& surface : motion.surfaces())
    if (!surface.membrane)
      blood_[index(field_.groupOf(surface.id))] =
          scene.medium(scene.structures[index(surface.id)].medium).blood;
  FieldFrame frame;
  float farthest_m2 = 0;
  for (int i = 0; i < kPhasesLookedAt; ++i) {
    field_.at(static_cast<double>(i) / kPhasesLookedAt, frame);
    for (const GroupFrame& group : frame.groups)
      for (const Vec3f d : group.displacement_m)
        farthest_m2 = std::max(farthest_m2, d.x * d.x + d.z * d.z);
  }
  along_m_ = kBetweenPhases * std::sqrt(static_cast<double>(farthest_m2));
  across_m_ = kBetweenPhases * field_.reachAcrossPlane();
  const float fine_m = static_cast<float>(field_.spacing());
  lattice_.block_m = fine_m > 0 ? 2 * fine_m : kStillBlock_m;
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

void FieldMaterial::groupsAt(std::span<const Vec3f> reference_m,
                             std::span<std::uint16_t> groups) const {
  std::vector<GroupId> ids(reference_m.size());
  field_.groupsAt(reference_m, ids);
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
