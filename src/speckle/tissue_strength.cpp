#include "speckle/tissue_strength.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/hash_random.h"
#include "scene/role.h"
#include "scene/scan_geometry.h"
#include "speckle/nearest_vertex.h"

namespace echocine {

namespace {

enum : std::uint64_t { kFine = 11, kCoarse = 12 };  // purposes of hashed numbers

Vec3d unitOf(Vec3d v) {
  return dot(v, v) > 0 ? normalised(v) : Vec3d{0, 0, 1};
}

Vec3d middleOf(std::span<const Vec3f> points_m) {
  Vec3d sum{};
  for (const Vec3f p : points_m) sum = sum + toDouble(p);
  return 1 / static_cast<double>(points_m.size()) * sum;
}

// A ventricle's long axis: the direction in which its vertices are spread most, away from what lies
// at its base.
Vec3d longAxis(std::span<const Vec3f> cavity_m, std::span<const Vec3f> base_m) {
  const Vec3d middle = middleOf(cavity_m);
  Vec3d axis{0.1, 0.2, 1};
  for (int step = 0; step < 50; ++step) {  // power iteration on the covariance
    Vec3d next{};
    for (const Vec3f p : cavity_m) {
      const Vec3d d = toDouble(p) - middle;
      next = next + dot(d, axis) * d;
    }
    axis = unitOf(next);
  }
  return !base_m.empty() && dot(middle - middleOf(base_m), axis) < 0 ? -axis : axis;
}

}  // namespace

const NormalField::Cell& NormalField::cellOf(const std::array<std::int64_t, 3>& node) {
  Cell& cell =
      cells_[static_cast<std::size_t>((node[0] & 3) | (node[1] & 3) << 2 | (node[2] & 3) << 4)];
  if (cell.known && cell.node == node) return cell;
  cell.node = node;
  cell.known = true;
  for (int corner = 0; corner < 8; ++corner) {
    std::uint64_t hash = seed_;
    for (std::size_t axis = 0; axis < 3; ++axis)
      hash = hashOf(hash, node[axis] + (corner >> axis & 1));
    cell.normals[static_cast<std::size_t>(corner)] =
        normalFromHashes(hashOf(hash, 0), hashOf(hash, 1));
  }
  return cell;
}

double NormalField::at(Vec3f place_m) {
  const double at[3] = {static_cast<double>(place_m.x) / scale_m_,
                        static_cast<double>(place_m.y) / scale_m_,
                        static_cast<double>(place_m.z) / scale_m_};
  std::array<std::int64_t, 3> node;
  double high[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double floor = std::floor(at[axis]), f = at[axis] - floor;
    node[axis] = static_cast<std::int64_t>(floor);
    high[axis] = f * f * (3 - 2 * f);
  }
  const Cell& cell = cellOf(node);
  double sum = 0, squares = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    double weight = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
      weight *= corner >> axis & 1 ? high[axis] : 1 - high[axis];
    sum += weight * cell.normals[corner];
    squares += weight * weight;
  }
  return sum / std::sqrt(squares);
}

Heterogeneity::Heterogeneity(const SpeckleSettings& settings)
    : s_(settings.heterogeneity_db * std::numbers::ln10 / 10),
      fine_(settings.heterogeneity_fine_m, hashOf(settings.heterogeneity_seed, kFine)),
      coarse_(settings.heterogeneity_coarse_m, hashOf(settings.heterogeneity_seed, kCoarse)) {}

double Heterogeneity::at(Vec3f place_m) {
  const double n = (fine_.at(place_m) + coarse_.at(place_m)) / std::numbers::sqrt2;
  return std::exp(s_ * n - s_ * s_ / 2);
}

Vec3d fibreAt(Vec3d n, Vec3d a, double depth, double helix_angle_rad) {
  const Vec3d round = unitOf(cross(a, n)), along = cross(n, round);
  const double h = helix_angle_rad * (1 - 2 * depth);
  return std::cos(h) * round + std::sin(h) * along;
}

double fibreFactor(Vec3d fibre, Vec3d beam, double anisotropy_db) {
  const double cosine = dot(fibre, beam);
  return std::pow(10, -anisotropy_db * cosine * cosine / 10);
}

struct TissueStrength::Wall {
  std::uint16_t group;
  NearestVertex endocardium, epicardium;
  Vec3d axis;
};

TissueStrength::TissueStrength(const Scene& scene, const EffectPlan& plan, const MeshMotion& motion,
                               const MotionField& field)
    : settings_(scene.speckle), probe_(scene.probe) {
  if (!plan.heterogeneity) settings_.heterogeneity_db = 0;
  const auto wall = structureOf(scene, Role::lv_wall), cavity = structureOf(scene, Role::lv_cavity);
  if (!plan.anisotropy || !wall || !cavity) return;
  SurfaceFrame frame;
  motion.frameAt(field.referencePhase(), frame, false);
  const std::vector<Vec3f>& inner = frame.positions_m[index(*cavity)];
  const auto atrium = structureOf(scene, Role::la), valve = structureOf(scene, Role::mitral_valve);
  const auto base = valve ? valve : atrium;
  wall_ = std::make_unique<const Wall>(
      Wall{static_cast<std::uint16_t>(index(field.groupOf(*wall))), NearestVertex(inner),
           NearestVertex(frame.positions_m[index(*wall)]),
           longAxis(inner, base ? std::span<const Vec3f>(frame.positions_m[index(*base)])
                                : std::span<const Vec3f>())});
}

TissueStrength::~TissueStrength() = default;

void TissueStrength::amplitudes(std::span<const Vec3f> reference_m, std::uint16_t group, bool blood,
                                std::span<float> out) const {
  const Vec3d parallel = lineGeometry(probe_, probe_.lines / 2).direction;
  Heterogeneity heterogeneity(settings_);
  for (std::size_t i = 0; i < out.size(); ++i) {
    double factor = blood || settings_.heterogeneity_db == 0 ? 1 : heterogeneity.at(reference_m[i]);
    if (wall_ && group == wall_->group) {
      const Vec3d p = toDouble(reference_m[i]),
                  in = toDouble(wall_->endocardium.to(reference_m[i])),
                  out_m = toDouble(wall_->epicardium.to(reference_m[i]));
      const double inside = std::sqrt(dot(p - in, p - in)),
                   outside = std::sqrt(dot(p - out_m, p - out_m));
      const Vec3d beam = probe_.kind == ProbeKind::linear ? parallel : unitOf(p);
      factor *=
          fibreFactor(fibreAt(unitOf(out_m - in), wall_->axis,
                              inside / std::max(inside + outside, 1e-9), settings_.helix_angle_rad),
                      beam, settings_.anisotropy_db);
    }
    out[i] = static_cast<float>(std::sqrt(factor));
  }
}

}  // namespace echocine
