// Strain, thickness and twist of the left ventricle: the part of HeartFunction that follows its
// material.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/stop.h"
#include "core/units.h"
#include "truth/heart_function.h"
#include "truth/surface_normals.h"
#include "truth/surface_weights.h"

namespace echocine {

namespace {

// Half the base over which strain is measured, and the steps in which the wall is felt. Our
// choices.
constexpr float kReach_m = 1e-3f, kStep_m = 0.25e-3f, kThickest_m = 30e-3f;
// Across to the axis the direction along a meridian is not known, and at the apex it does not
// matter.
constexpr double kAcross = 0.2;
// Planes through the long axis that the wall's meridians are taken from. Our choice.
constexpr int kMeridianPlanes = 36;
// Twist is measured above the cap, whose rotation is ill-defined.
constexpr double kTwistZeta = 0.9;

}  // namespace

// From every vertex of the endocardium outwards, until the wall ends.
void HeartFunction::findColumns(const SurfaceFrame& surfaces) {
  const std::vector<Vec3f>& p = surfaces.positions_m[index(cavity_)];
  const std::vector<Vec3d> normals = vertexNormals(motion_.surfaces()[index(cavity_)].triangles, p);
  for (std::uint32_t v = 0; v < p.size(); ++v) {
    checkpoint();
    if (!(length(normals[v]) > 0)) continue;
    const Vec3d radial = normalised(normals[v]);
    const Vec3f n = toFloat(radial);
    float thickness_m = kStep_m;
    while (thickness_m < kThickest_m && field_.surfaceAt(p[v] + thickness_m * n) == wall_)
      thickness_m += kStep_m;
    Vec3d along = acrossAxis(axes_.axis, radial);
    const bool across = length(along)<kAcross, apical = dot(radial, axes_.axis)> 0;
    if (thickness_m < 4 * kStep_m || thickness_m >= kThickest_m || (across && !apical)) continue;
    if (length(along) < 1e-3) along = acrossAxis(axes_.septal, radial);
    const Vec3d longitudinal = normalised(along);
    columns_.push_back({v, p[v], p[v] + 0.5f * thickness_m * n,
                        p[v] + (thickness_m - 0.5f * kStep_m) * n, n, toFloat(longitudinal),
                        toFloat(cross(radial, longitudinal)), ahaSegment(axes_, toDouble(p[v]))});
  }
  weighColumns(normals, p);
}

// The middle of the wall is meshed as the endocardium is, half the thickness outside it; where no
// column stands, by half the mean thickness. Triangles at the border of the columns count by their
// part inside it.
void HeartFunction::weighColumns(std::span<const Vec3d> normals,
                                 std::span<const Vec3f> endocardium) {
  const std::vector<Triangle>& triangles = motion_.surfaces()[index(cavity_)].triangles;
  double half_m = 0;
  for (const WallColumn& c : columns_)
    half_m +=
        static_cast<double>(length(c.mid_m - c.endo_m)) / static_cast<double>(columns_.size());
  std::vector<Vec3d> middle_m;
  for (std::size_t v = 0; v < endocardium.size(); ++v) {
    const bool flat = !(length(normals[v]) > 0);
    middle_m.push_back(toDouble(endocardium[v]) +
                       (flat ? Vec3d{} : half_m * normalised(normals[v])));
  }
  for (const WallColumn& c : columns_) middle_m[c.vertex] = toDouble(c.mid_m);
  // Over 0 where a direction along the meridian is known.
  std::vector<double> known;
  for (const Vec3d normal : normals) {
    const bool flat = !(length(normal) > 0);
    const Vec3d radial = flat ? normal : normalised(normal);
    const bool taken = flat || dot(radial, axes_.axis) > 0;
    known.push_back(taken ? 1 : length(acrossAxis(axes_.axis, radial)) - kAcross);
  }
  const SurfacePart wall{triangles, middle_m, known};
  const std::vector<double> areas = vertexAreas(wall);
  std::vector<double> meridians(middle_m.size(), 0), view(middle_m.size(), 0);
  for (int i = 0; i < kMeridianPlanes; ++i) {
    const double turn = std::numbers::pi * (i + 0.5) / kMeridianPlanes;
    addCutLengths(wall, axes_.base_m,
                  std::cos(turn) * axes_.septal + std::sin(turn) * axes_.anterior, meridians);
  }
  addCutLengths(wall, {}, {0, 1, 0}, view);
  for (const WallColumn& c : columns_)
    weights_.push_back({areas[c.vertex], meridians[c.vertex], view[c.vertex]});
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

void HeartFunction::Means::add(const WallColumn& column, double by_length, double by_area,
                               const Lengths& now, const Lengths& first) {
  const auto s = static_cast<std::size_t>(column.segment - 1);
  const double strain = now.longitudinal / first.longitudinal - 1;
  longitudinal += by_length * strain;
  length += by_length;
  lengths[s] += by_length;
  areas[s] += by_area;
  sums[s].longitudinal += by_length * strain;
  sums[s].radial += by_area * (now.thickness / first.thickness - 1);
  sums[s].circumferential += by_area * (now.circumferential / first.circumferential - 1);
  sums[s].thickness_mm += by_area * millimetresFromMetres(now.thickness);
}

SegmentStrains HeartFunction::Means::segments() const {
  SegmentStrains means{};
  for (std::size_t s = 0; s < kAhaSegments; ++s) {
    const auto share = [](double weight) {
      return weight > 0 ? 1 / weight : std::numeric_limits<double>::quiet_NaN();
    };
    const double of_area = share(areas[s]);
    means[s] = {share(lengths[s]) * sums[s].longitudinal, of_area * sums[s].radial,
                of_area * sums[s].circumferential, of_area * sums[s].thickness_mm};
  }
  return means;
}

double HeartFunction::Means::global() const {
  return length > 0 ? longitudinal / length : std::numeric_limits<double>::quiet_NaN();
}

// Twist is the slope of the rotation over the length, by least squares over the wall's area, from
// base to apex.
void HeartFunction::addStrain(const SurfaceFrame& surfaces, const FieldFrame& field,
                              FunctionFrame& f) const {
  Means whole, view;
  const std::vector<double> turned = rotations(surfaces);
  double n = 0, sum_z = 0, sum_zz = 0, sum_t = 0, sum_zt = 0;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const WallColumn& column = columns_[i];
    const Lengths now = lengths(column, surfaces, field);
    const Weight& weight = weights_[i];
    whole.add(column, weight.meridians_m, weight.area_m2, now, first_lengths_[i]);
    view.add(column, weight.view_m, weight.view_m, now, first_lengths_[i]);
    const double zeta = axes_.zeta(toDouble(column.endo_m));
    if (zeta > kTwistZeta) continue;
    const double turn = std::remainder(turned[i] - first_rotations_[i], 2 * std::numbers::pi);
    n += weight.area_m2;
    sum_z += weight.area_m2 * zeta;
    sum_zz += weight.area_m2 * zeta * zeta;
    sum_t += weight.area_m2 * turn;
    sum_zt += weight.area_m2 * zeta * turn;
  }
  f.segments = whole.segments();
  f.global_longitudinal_strain = whole.global();
  f.view_segments = view.segments();
  f.view_longitudinal_strain = view.global();
  const double spread = n * sum_zz - sum_z * sum_z;
  if (spread > 0) f.twist_deg = degreesFromRadians((n * sum_zt - sum_z * sum_t) / spread);
}

}  // namespace echocine
