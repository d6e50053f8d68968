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

constexpr int kDiscs = 20;
// Half the base over which strain is measured, and the steps in which the wall is felt. Our
// choices.
constexpr float kReach_m = 1e-3f, kStep_m = 0.25e-3f, kThickest_m = 30e-3f;

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
      wall_(required(scene, Role::lv_wall)) {
  SurfaceFrame surfaces;
  motion.frameAt(field.referencePhase(), surfaces);
  findAxis(surfaces);
  findColumns(surfaces);
  if (columns_.empty())
    throw SceneError(atPlace(
        scene.truth.function_place,
        fmt::format("{} has no wall of {} round it: strain has nothing to be measured in",
                    scene.structures[index(cavity_)].name, scene.structures[index(wall_)].name)));
  FieldFrame first;
  field.at(first_phase, first);
  motion.frameAt(first_phase, surfaces);
  first_base_m_ = baseIn(surfaces);
  first_axis_ = normalised(apexIn(surfaces, first_base_m_) - first_base_m_);
  for (const WallColumn& column : columns_) first_.push_back(lengths(column, surfaces, first));
}

// The base is where the cavity's surface meets the left atrium; without one, where it ends at
// something else than wall and papillary muscles. Where it nowhere
// does, the end that is farthest along the first guess of an axis.
void HeartFunction::findAxis(const SurfaceFrame& surfaces) {
  const std::vector<Vec3f>& p = surfaces.positions_m[index(cavity_)];
  const std::vector<Vec3d> normals = vertexNormals(motion_.surfaces()[index(cavity_)], p);
  const auto atrium = structureOf(scene_, Role::la);
  std::vector<std::uint32_t> at_atrium;
  for (std::uint32_t v = 0; v < p.size(); ++v) {
    if (!(length(normals[v]) > 0)) continue;
    const Vec3f outside = p[v] + 2 * kStep_m * toFloat(normalised(normals[v]));
    const auto beyond = field_.surfaceAt(outside);
    if (beyond && atrium && *beyond == *atrium) at_atrium.push_back(v);
    const bool papillary =
        beyond && roleOf(scene_.structures[index(*beyond)]) == Role::papillary_muscle;
    if (!papillary && beyond != wall_ && beyond != cavity_) base_.push_back(v);
  }
  if (!at_atrium.empty()) base_ = at_atrium;
  if (base_.empty()) {
    const Vec3d middle = middleOf(p);
    const auto far = std::max_element(p.begin(), p.end(), [&](Vec3f a, Vec3f b) {
      return length(toDouble(a) - middle) < length(toDouble(b) - middle);
    });
    base_.push_back(static_cast<std::uint32_t>(far - p.begin()));
  }
  base_m_ = baseIn(surfaces);
  const Vec3d apex_m = apexIn(surfaces, base_m_);
  length_m_ = length(apex_m - base_m_);
  axis_ = normalised(apex_m - base_m_);
  // The septum looks to the right ventricle; without one, to the left of the picture.
  Vec3d septal = acrossAxis({-1, 0, 0}, axis_);
  if (const auto right = structureOf(scene_, Role::rv_cavity))
    septal = acrossAxis(middleOf(surfaces.positions_m[index(*right)]) - middleOf(p), axis_);
  septal_ = length(septal) > 0 ? normalised(septal) : Vec3d{0, 1, 0};
  anterior_ = cross(septal_, axis_);
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
    const Vec3d along = acrossAxis(axis_, radial);
    if (thickness_m < 4 * kStep_m || thickness_m >= kThickest_m || length(along) < 0.2) continue;
    const Vec3d longitudinal = normalised(along);
    WallColumn column{v,
                      p[v],
                      p[v] + 0.5f * thickness_m * n,
                      p[v] + (thickness_m - 0.5f * kStep_m) * n,
                      n,
                      toFloat(longitudinal),
                      toFloat(cross(radial, longitudinal)),
                      segmentOf(toDouble(p[v]))};
    columns_.push_back(column);
  }
}

// Cerqueira et al., Circulation 105, 539-542, 2002: thirds of the length, six sectors, four at the
// apex, and a cap, here the last tenth.
int HeartFunction::segmentOf(Vec3d place_m) const {
  const Vec3d d = place_m - base_m_;
  const double zeta = dot(d, axis_) / length_m_;
  if (zeta > 0.9) return 17;
  const double degrees = degreesFromRadians(std::atan2(dot(d, anterior_), dot(d, septal_)));
  if (zeta > 2.0 / 3) {  // 13 anterior, 14 septal, 15 inferior, 16 lateral
    if (degrees > 45 && degrees <= 135) return 13;
    if (degrees > -45 && degrees <= 45) return 14;
    return degrees > -135 && degrees <= -45 ? 15 : 16;
  }
  // Anterior, anteroseptal, inferoseptal, inferior, inferolateral, anterolateral.
  const int ring = zeta > 1.0 / 3 ? 6 : 0;
  if (degrees > 60 && degrees <= 120) return ring + 1;
  if (degrees > 0 && degrees <= 60) return ring + 2;
  if (degrees > -60 && degrees <= 0) return ring + 3;
  if (degrees > -120 && degrees <= -60) return ring + 4;
  return ring + (degrees <= -120 ? 5 : 6);
}

HeartFunction::Lengths HeartFunction::lengths(const WallColumn& c, const SurfaceFrame& surfaces,
                                              const FieldFrame& field) const {
  const GroupFrame& group = field[field_.groupOf(wall_)];
  const auto across = [&](Vec3f direction) {
    return static_cast<double>(length(group.place(c.mid_m + kReach_m * direction) -
                                      group.place(c.mid_m - kReach_m * direction)));
  };
  const Vec3f endo_m = surfaces.positions_m[index(cavity_)][c.vertex];
  return {across(c.longitudinal), across(c.radial), across(c.circumferential),
          static_cast<double>(length(group.place(c.epi_m) - endo_m))};
}

Vec3d HeartFunction::baseIn(const SurfaceFrame& surfaces) const {
  Vec3d sum;
  for (const std::uint32_t v : base_) sum = sum + toDouble(surfaces.positions_m[index(cavity_)][v]);
  return (1.0 / static_cast<double>(base_.size())) * sum;
}

Vec3d HeartFunction::apexIn(const SurfaceFrame& surfaces, Vec3d base_m) const {
  const std::vector<Vec3f>& p = surfaces.positions_m[index(cavity_)];
  return toDouble(*std::max_element(p.begin(), p.end(), [&](Vec3f a, Vec3f b) {
    return length(toDouble(a) - base_m) < length(toDouble(b) - base_m);
  }));
}

// Widths of the cavity at the discs' middles, in the plane through the axis and `across`.
std::vector<double> HeartFunction::diameters(const SurfaceFrame& surfaces, Vec3d base_m,
                                             Vec3d apex_m, Vec3d across) const {
  const Vec3d axis = normalised(apex_m - base_m), wide = normalised(acrossAxis(across, axis)),
              normal = cross(axis, wide);
  const double length_m = length(apex_m - base_m);
  std::vector<std::vector<double>> ends(kDiscs);
  const std::vector<Vec3f>& p = surfaces.positions_m[index(cavity_)];
  for (const Triangle& t : motion_.surfaces()[index(cavity_)].triangles) {
    Vec3d cut[2];
    int count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t lower = std::min(t[i], t[(i + 1) % 3]),
                          upper = std::max(t[i], t[(i + 1) % 3]);
      const Vec3d a = toDouble(p[lower]) - base_m, b = toDouble(p[upper]) - base_m;
      const double ha = dot(a, normal), hb = dot(b, normal);
      if ((ha >= 0) != (hb >= 0) && count < 2) cut[count++] = a + (ha / (ha - hb)) * (b - a);
    }
    if (count < 2) continue;
    const double z0 = dot(cut[0], axis), z1 = dot(cut[1], axis);
    for (int i = 0; i < kDiscs; ++i) {
      const double z = (i + 0.5) * length_m / kDiscs;
      if ((z0 >= z) == (z1 >= z)) continue;
      const Vec3d at = cut[0] + ((z - z0) / (z1 - z0)) * (cut[1] - cut[0]);
      ends[static_cast<std::size_t>(i)].push_back(dot(at, wide));
    }
  }
  std::vector<double> widths;
  for (std::vector<double>& list : ends) {
    std::sort(list.begin(), list.end());
    double width = 0;
    for (std::size_t i = 0; i + 1 < list.size(); i += 2) width += list[i + 1] - list[i];
    widths.push_back(width);
  }
  return widths;
}

FunctionFrame HeartFunction::at(const SurfaceFrame& surfaces, const FieldFrame& field) const {
  FunctionFrame f;
  std::array<int, kAhaSegments> counts{};
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Lengths now = lengths(columns_[i], surfaces, field);
    const double longitudinal = now.longitudinal / first_[i].longitudinal - 1;
    f.global_longitudinal_strain += longitudinal / static_cast<double>(columns_.size());
    const auto s = static_cast<std::size_t>(columns_[i].segment - 1);
    ++counts[s];
    f.segments[s].longitudinal += longitudinal;
    f.segments[s].radial += now.radial / first_[i].radial - 1;
    f.segments[s].circumferential += now.circumferential / first_[i].circumferential - 1;
    f.segments[s].thickness_mm += millimetresFromMetres(now.thickness);
  }
  for (std::size_t s = 0; s < kAhaSegments; ++s) {
    const double share = counts[s] > 0 ? 1.0 / counts[s] : std::numeric_limits<double>::quiet_NaN();
    SegmentStrain& segment = f.segments[s];
    segment = {share * segment.longitudinal, share * segment.radial,
               share * segment.circumferential, share * segment.thickness_mm};
  }
  f.base_m = baseIn(surfaces);
  f.apex_m = apexIn(surfaces, f.base_m);
  const double length_m = length(f.apex_m - f.base_m);
  f.length_mm = millimetresFromMetres(length_m);
  f.base_descent_mm = millimetresFromMetres(dot(f.base_m - first_base_m_, first_axis_));
  const double volume_m3 = motion_.volumeIn(surfaces, motion_.surfaces()[index(cavity_)]);
  f.volume_ml = millilitresFromCubicMetres(volume_m3);
  f.sphericity = volume_m3 / (std::numbers::pi / 6 * length_m * length_m * length_m);
  const double disc = std::numbers::pi / 4 * length_m / kDiscs;
  const auto simpson = [&](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return millilitresFromCubicMetres(disc * sum);
  };
  f.biplane_ml = simpson(diameters(surfaces, f.base_m, f.apex_m, septal_),
                         diameters(surfaces, f.base_m, f.apex_m, anterior_));
  // The imaging plane's own normal is y; an axis that leaves it by more than 30 degrees is not
  // shown.
  const Vec3d axis = normalised(f.apex_m - f.base_m);
  if (std::abs(axis.y) < 0.5) {
    const Vec3d base_m{f.base_m.x, 0, f.base_m.z}, apex_m{f.apex_m.x, 0, f.apex_m.z};
    const Vec3d across = cross(Vec3d{0, 1, 0}, normalised(apex_m - base_m));
    const std::vector<double> widths = diameters(surfaces, base_m, apex_m, across);
    const double shown = length(apex_m - base_m) / length_m;
    f.single_plane_ml = shown * simpson(widths, widths);
  }
  return f;
}

}  // namespace echocine
