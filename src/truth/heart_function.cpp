#include "truth/heart_function.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/units.h"
#include "scene/names.h"
#include "truth/surface_normals.h"
#include "truth/surface_weights.h"

namespace echocine {

namespace {

SurfaceId required(const Scene& scene, Role role) {
  const auto found = structureOf(scene, role);
  if (!found)
    throw SceneError(atPlace(
        scene.truth.function_place,
        fmt::format("tracks and function need a structure with role = \"{}\": set the role, or "
                    "omit them from truth.write",
                    nameOf(role))));
  return *found;
}

// So far from a surface its neighbour is looked for. Our choice.
constexpr float kBeyond_m = 0.5e-3f;

// Just outside each vertex; nothing where faces have no area.
std::vector<std::optional<Vec3f>> outsideOf(const SurfaceTopology& surface,
                                            const std::vector<Vec3f>& p) {
  std::vector<std::optional<Vec3f>> outside(p.size());
  const std::vector<Vec3d> normals = vertexNormals(surface.triangles, p);
  for (std::size_t v = 0; v < p.size(); ++v)
    if (length(normals[v]) > 0) outside[v] = p[v] + kBeyond_m * toFloat(normalised(normals[v]));
  return outside;
}

}  // namespace

HeartFunction::HeartFunction(const Scene& scene, const MeshMotion& motion, const MotionField& field,
                             double first_phase)
    : scene_(scene),
      motion_(motion),
      field_(field),
      cavity_(required(scene, Role::lv_cavity)),
      wall_(required(scene, Role::lv_wall)),
      right_(structureOf(scene, Role::rv_cavity)) {
  SurfaceFrame surfaces;
  motion.frameAt(field.referencePhase(), surfaces);
  findBase(surfaces);
  findAxes(surfaces);
  findColumns(surfaces);
  if (columns_.empty())
    throw SceneError(atPlace(
        scene.truth.function_place,
        fmt::format("{} has no wall of {} around it, so strain cannot be measured",
                    scene.structures[index(cavity_)].name, scene.structures[index(wall_)].name)));
  FieldFrame first;
  field.at(first_phase, first);
  motion.frameAt(first_phase, surfaces);
  first_ = axisIn(surfaces);
  if (hasRightHeart()) first_lateral_m_ = toDouble(surfaces.positions_m[index(*right_)][lateral_]);
  for (const WallColumn& column : columns_)
    first_lengths_.push_back(lengths(column, surfaces, first));
  first_rotations_ = rotations(surfaces);
}

Orifice HeartFunction::orificeOf(SurfaceId cavity, Role beyond,
                                 const SurfaceFrame& surfaces) const {
  const auto other = structureOf(scene_, beyond);
  if (!other) return {};
  const SurfaceTopology& surface = motion_.surfaces()[index(cavity)];
  const auto outside = outsideOf(surface, surfaces.positions_m[index(cavity)]);
  std::vector<std::uint32_t> bordering;
  for (std::uint32_t v = 0; v < outside.size(); ++v)
    if (outside[v] && field_.surfaceAt(*outside[v]) == other) bordering.push_back(v);
  return {surface.triangles, bordering};
}

// The base is where the cavity's surface meets the left atrium; without one, where it ends at
// something else than wall and papillary muscles. Where it nowhere does, the end that is farthest
// from the middle.
void HeartFunction::findBase(const SurfaceFrame& surfaces) {
  const SurfaceTopology& surface = motion_.surfaces()[index(cavity_)];
  const std::vector<Vec3f>& p = surfaces.positions_m[index(cavity_)];
  mitral_ = orificeOf(cavity_, Role::la, surfaces);
  aortic_ = orificeOf(cavity_, Role::aorta, surfaces);
  if (right_) tricuspid_ = orificeOf(*right_, Role::ra, surfaces);
  if (!mitral_.empty()) return;
  const auto outside = outsideOf(surface, p);
  for (std::uint32_t v = 0; v < p.size(); ++v) {
    if (!outside[v]) continue;
    const auto beyond = field_.surfaceAt(*outside[v]);
    const bool papillary =
        beyond && roleOf(scene_.structures[index(*beyond)]) == Role::papillary_muscle;
    if (!papillary && beyond != wall_ && beyond != cavity_) base_.push_back(v);
  }
  if (base_.empty()) {
    const Vec3d middle = surfaceMiddle(surface.triangles, p);
    const auto far = std::max_element(p.begin(), p.end(), [&](Vec3f a, Vec3f b) {
      return length(toDouble(a) - middle) < length(toDouble(b) - middle);
    });
    base_.push_back(static_cast<std::uint32_t>(far - p.begin()));
  }
  mitral_ = Orifice(surface.triangles, base_);
}

void HeartFunction::findAxes(const SurfaceFrame& surfaces) {
  const LongAxis axis = axisIn(surfaces);
  axes_.base_m = axis.base_m;
  axes_.length_m = length(axis.apex_m - axis.base_m);
  axes_.axis = normalised(axis.apex_m - axis.base_m);
  const auto middleOf = [&](SurfaceId s) {
    return surfaceMiddle(motion_.surfaces()[index(s)].triangles, surfaces.positions_m[index(s)]);
  };
  // The septum looks to the right ventricle; without one, to the left of the picture.
  Vec3d septal = acrossAxis({-1, 0, 0}, axes_.axis);
  if (right_) septal = acrossAxis(middleOf(*right_) - middleOf(cavity_), axes_.axis);
  axes_.septal = length(septal) > 0 ? normalised(septal) : Vec3d{0, 1, 0};
  axes_.anterior = cross(axes_.septal, axes_.axis);
  if (hasRightHeart())
    lateral_ = tricuspid_.farthest(surfaces.positions_m[index(*right_)], axes_.septal);
}

// From the middle of the mitral ring to the farthest place of the cavity: as far as its farthest
// vertex, in the direction of the area there.
LongAxis HeartFunction::axisIn(const SurfaceFrame& surfaces) const {
  const std::vector<Vec3f>& p = surfaces.positions_m[index(cavity_)];
  const Vec3d base_m = mitral_.empty() ? toDouble(p[base_.front()]) : mitral_.middle(p);
  return {base_m, farthestPlace(motion_.surfaces()[index(cavity_)].triangles, p, base_m)};
}

void HeartFunction::addRings(const SurfaceFrame& surfaces, FunctionFrame& f) const {
  const auto ring = [&](const Orifice& orifice, SurfaceId cavity) -> std::optional<RingFrame> {
    if (orifice.empty()) return std::nullopt;
    const std::vector<Vec3f>& p = surfaces.positions_m[index(cavity)];
    return RingFrame{orifice.middle(p), orifice.hinges(p)};
  };
  f.mitral = ring(mitral_, cavity_);
  f.aortic = ring(aortic_, cavity_);
  if (right_) f.tricuspid = ring(tricuspid_, *right_);
  const Vec3d along = normalised(first_.apex_m - first_.base_m);
  f.base_descent_mm = millimetresFromMetres(dot(f.axis.base_m - first_.base_m, along));
  if (hasRightHeart()) {
    const Vec3d lateral_m = toDouble(surfaces.positions_m[index(*right_)][lateral_]);
    f.tricuspid_descent_mm = millimetresFromMetres(dot(lateral_m - first_lateral_m_, along));
  }
}

void HeartFunction::addVolumes(const SurfaceFrame& surfaces, FunctionFrame& f) const {
  const std::vector<Vec3f>& p = surfaces.positions_m[index(cavity_)];
  const SurfaceTopology& surface = motion_.surfaces()[index(cavity_)];
  const double length_m = length(f.axis.apex_m - f.axis.base_m);
  const double volume_m3 = motion_.volumeIn(surfaces, surface);
  f.volume_ml = millilitresFromCubicMetres(volume_m3);
  f.sphericity = volume_m3 / (std::numbers::pi / 6 * length_m * length_m * length_m);
  f.biplane_ml = millilitresFromCubicMetres(
      discVolume(length_m, discWidths(surface.triangles, p, f.axis, axes_.septal),
                 discWidths(surface.triangles, p, f.axis, axes_.anterior)));
  // The imaging plane's own normal is y; an axis that leaves it by more than 30 degrees is not
  // shown.
  if (std::abs(normalised(f.axis.apex_m - f.axis.base_m).y) >= 0.5) return;
  const LongAxis shown{{f.axis.base_m.x, 0, f.axis.base_m.z},
                       {f.axis.apex_m.x, 0, f.axis.apex_m.z}};
  const Vec3d span = shown.apex_m - shown.base_m;
  const std::vector<double> widths =
      discWidths(surface.triangles, p, shown, cross(Vec3d{0, 1, 0}, normalised(span)));
  f.single_plane_ml = millilitresFromCubicMetres(discVolume(length(span), widths, widths));
}

FunctionFrame HeartFunction::at(const SurfaceFrame& surfaces, const FieldFrame& field) const {
  FunctionFrame f;
  f.axis = axisIn(surfaces);
  f.length_mm = millimetresFromMetres(length(f.axis.apex_m - f.axis.base_m));
  addStrain(surfaces, field, f);
  addRings(surfaces, f);
  addVolumes(surfaces, f);
  return f;
}

}  // namespace echocine
