#include "truth/heart_function.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/units.h"
#include "scene/names.h"

namespace echocine {

namespace {

// Half the base over which strain is measured, and the steps in which the wall is felt. Our
// choices.
constexpr float kReach_m = 1e-3f, kStep_m = 0.25e-3f, kThickest_m = 30e-3f;
// Wall whose middle is this near to the imaging plane is in the view: about half a beam. Our
// choice.
constexpr float kInView_m = 3e-3f;
// Twist is measured above the cap, whose rotation is ill-defined.
constexpr double kTwistZeta = 0.9;

SurfaceId required(const Scene& scene, Role role) {
  const auto found = structureOf(scene, role);
  if (!found)
    throw SceneError(atPlace(
        scene.truth.function_place,
        fmt::format("tracks and function need a structure that is {}: name one so, or leave "
                    "them out of truth.write",
                    nameOf(role))));
  return *found;
}

Vec3d middleOf(const std::vector<Vec3f>& points) {
  Vec3d sum;
  for (const Vec3f p : points) sum = sum + toDouble(p);
  return (1.0 / static_cast<double>(points.size())) * sum;
}

std::vector<Vec3d> vertexNormals(const SurfaceTopology& surface, const std::vector<Vec3f>& p) {
  std::vector<Vec3d> normals(p.size());
  for (const Triangle& t : surface.triangles) {
    const Vec3d n = cross(toDouble(p[t[1]] - p[t[0]]), toDouble(p[t[2]] - p[t[0]]));
    for (const std::uint32_t v : t) normals[v] = normals[v] + n;
  }
  return normals;
}

// Just outside each vertex; nothing where faces have no area.
std::vector<std::optional<Vec3f>> outsideOf(const SurfaceTopology& surface,
                                            const std::vector<Vec3f>& p) {
  std::vector<std::optional<Vec3f>> outside(p.size());
  const std::vector<Vec3d> normals = vertexNormals(surface, p);
  for (std::size_t v = 0; v < p.size(); ++v)
    if (length(normals[v]) > 0) outside[v] = p[v] + 2 * kStep_m * toFloat(normalised(normals[v]));
  return outside;
}

Vec3d acrossAxis(Vec3d v, Vec3d axis) {
  return v - dot(v, axis) * axis;
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
        fmt::format("{} has no wall of {} round it: strain has nothing to be measured in",
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
    const Vec3d middle = middleOf(p);
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
  // The septum looks to the right ventricle; without one, to the left of the picture.
  Vec3d septal = acrossAxis({-1, 0, 0}, axes_.axis);
  if (right_)
    septal = acrossAxis(middleOf(surfaces.positions_m[index(*right_)]) -
                            middleOf(surfaces.positions_m[index(cavity_)]),
                        axes_.axis);
  axes_.septal = length(septal) > 0 ? normalised(septal) : Vec3d{0, 1, 0};
  axes_.anterior = cross(axes_.septal, axes_.axis);
  if (hasRightHeart())
    lateral_ = tricuspid_.farthest(surfaces.positions_m[index(*right_)], axes_.septal);
}

// From every vertex of the endocardium outwards, until the wall ends.
void HeartFunction::findColumns(const SurfaceFrame& surfaces) {
  const std::vector<Vec3f>& p = surfaces.positions_m[index(cavity_)];
  const std::vector<Vec3d> normals = vertexNormals(motion_.surfaces()[index(cavity_)], p);
  for (std::uint32_t v = 0; v < p.size(); ++v) {
    if (!(length(normals[v]) > 0)) continue;
    const Vec3d radial = normalised(normals[v]);
    const Vec3f n = toFloat(radial);
    float thickness_m = kStep_m;
    while (thickness_m < kThickest_m && field_.surfaceAt(p[v] + thickness_m * n) == wall_)
      thickness_m += kStep_m;
    const Vec3d along = acrossAxis(axes_.axis, radial);
    if (thickness_m < 4 * kStep_m || thickness_m >= kThickest_m || length(along) < 0.2) continue;
    const Vec3d longitudinal = normalised(along);
    columns_.push_back({v,
                        p[v],
                        p[v] + 0.5f * thickness_m * n,
                        p[v] + (thickness_m - 0.5f * kStep_m) * n,
                        n,
                        toFloat(longitudinal),
                        toFloat(cross(radial, longitudinal)),
                        ahaSegment(axes_, toDouble(p[v]))});
  }
}

HeartFunction::Lengths HeartFunction::lengths(const WallColumn& c, const SurfaceFrame& surfaces,
                                              const FieldFrame& field) const {
  const GroupFrame& group = field[field_.groupOf(wall_)];
  const auto across = [&](Vec3f direction) {
    return static_cast<double>(length(group.place(c.mid_m + kReach_m * direction) -
                                      group.place(c.mid_m - kReach_m * direction)));
  };
  const Vec3f endo_m = surfaces.positions_m[index(cavity_)][c.vertex];
  return {across(c.longitudinal), across(c.circumferential),
          static_cast<double>(length(group.place(c.epi_m) - endo_m))};
}

// From the middle of the mitral ring to the farthest place of the cavity.
LongAxis HeartFunction::axisIn(const SurfaceFrame& surfaces) const {
  const std::vector<Vec3f>& p = surfaces.positions_m[index(cavity_)];
  const Vec3d base_m =
      mitral_.empty() ? toDouble(p[base_.front()]) : mitral_.middle(p);
  const auto apex = std::max_element(p.begin(), p.end(), [&](Vec3f a, Vec3f b) {
    return length(toDouble(a) - base_m) < length(toDouble(b) - base_m);
  });
  return {base_m, toDouble(*apex)};
}

ViewLandmarks HeartFunction::landmarks(const SurfaceFrame& at_reference) const {
  ViewLandmarks marks{axes_, {}, {}};
  if (hasRightHeart())
    marks.tricuspid_m = tricuspid_.middle(at_reference.positions_m[index(*right_)]);
  if (!aortic_.empty()) marks.aortic_m = aortic_.middle(at_reference.positions_m[index(cavity_)]);
  return marks;
}

// About the frame's own long axis, by column, rad; the septal direction is carried along with it.
std::vector<double> HeartFunction::rotations(const SurfaceFrame& surfaces) const {
  const LongAxis now = axisIn(surfaces);
  const Vec3d axis = normalised(now.apex_m - now.base_m);
  const Vec3d from = normalised(acrossAxis(axes_.septal, axis)), to = cross(axis, from);
  std::vector<double> rotations;
  for (const WallColumn& c : columns_) {
    const Vec3d d = toDouble(surfaces.positions_m[index(cavity_)][c.vertex]) - now.base_m;
    rotations.push_back(std::atan2(dot(d, to), dot(d, from)));
  }
  return rotations;
}

void HeartFunction::Means::add(const WallColumn& column, const Lengths& now,
                               const Lengths& first) {
  const auto s = static_cast<std::size_t>(column.segment - 1);
  const double strain = now.longitudinal / first.longitudinal - 1;
  longitudinal += strain;
  ++count;
  ++counts[s];
  sums[s].longitudinal += strain;
  sums[s].radial += now.thickness / first.thickness - 1;
  sums[s].circumferential += now.circumferential / first.circumferential - 1;
  sums[s].thickness_mm += millimetresFromMetres(now.thickness);
}

SegmentStrains HeartFunction::Means::segments() const {
  SegmentStrains means{};
  for (std::size_t s = 0; s < kAhaSegments; ++s) {
    const double share = counts[s] > 0 ? 1.0 / counts[s] : std::numeric_limits<double>::quiet_NaN();
    means[s] = {share * sums[s].longitudinal, share * sums[s].radial,
                share * sums[s].circumferential, share * sums[s].thickness_mm};
  }
  return means;
}

double HeartFunction::Means::global() const {
  return count > 0 ? longitudinal / count : std::numeric_limits<double>::quiet_NaN();
}

// Twist is the slope of the rotation over the length, by least squares, from base to apex.
void HeartFunction::addStrain(const SurfaceFrame& surfaces, const FieldFrame& field,
                              FunctionFrame& f) const {
  Means whole, view;
  const std::vector<double> turned = rotations(surfaces);
  double n = 0, sum_z = 0, sum_zz = 0, sum_t = 0, sum_zt = 0;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const WallColumn& column = columns_[i];
    const Lengths now = lengths(column, surfaces, field);
    whole.add(column, now, first_lengths_[i]);
    if (std::abs(column.mid_m.y) <= kInView_m) view.add(column, now, first_lengths_[i]);
    const double zeta = axes_.zeta(toDouble(column.endo_m));
    if (zeta > kTwistZeta) continue;
    const double turn =
        std::remainder(turned[i] - first_rotations_[i], 2 * std::numbers::pi);
    n += 1;
    sum_z += zeta;
    sum_zz += zeta * zeta;
    sum_t += turn;
    sum_zt += zeta * turn;
  }
  f.segments = whole.segments();
  f.global_longitudinal_strain = whole.global();
  f.view_segments = view.segments();
  f.view_longitudinal_strain = view.global();
  const double spread = n * sum_zz - sum_z * sum_z;
  if (spread > 0) f.twist_deg = degreesFromRadians((n * sum_zt - sum_z * sum_t) / spread);
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
  const LongAxis shown{{f.axis.base_m.x, 0, f.axis.base_m.z}, {f.axis.apex_m.x, 0, f.axis.apex_m.z}};
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
