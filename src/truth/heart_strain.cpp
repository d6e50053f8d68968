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
    const Vec3d along = acrossAxis(axes_.axis, radial);
    if (thickness_m < 4 * kStep_m || thickness_m >= kThickest_m || length(along) < 0.2) continue;
    const Vec3d longitudinal = normalised(along);
    columns_.push_back({v, p[v], p[v] + 0.5f * thickness_m * n,
                        p[v] + (thickness_m - 0.5f * kStep_m) * n, n, toFloat(longitudinal),
                        toFloat(cross(radial, longitudinal)), ahaSegment(axes_, toDouble(p[v]))});
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

void HeartFunction::Means::add(const WallColumn& column, const Lengths& now, const Lengths& first) {
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
    const double turn = std::remainder(turned[i] - first_rotations_[i], 2 * std::numbers::pi);
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

}  // namespace echocine
