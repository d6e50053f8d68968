#include "speckle/tissue_strength.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/hash_random.h"
#include "scene/role.h"
#include "scene/scan_geometry.h"
#include "speckle/nearest_on_surface.h"

namespace echocine {

namespace {

enum : std::uint64_t { kFine = 11, kLayers = 12 };  // purposes of hashed numbers

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

Heterogeneity::Heterogeneity(const SpeckleSettings& settings, const Probe& probe)
    : s_(settings.heterogeneity_db * std::numbers::ln10 / 10),
      extent_m_(settings.heterogeneity_coarse_m),
      per_thickness_(1 / settings.heterogeneity_layer_m),
      middle_m_(probe.face_radius_m + probe.middleDepth()),
      tangent_(std::tan(probe.first_angle_rad)),
      linear_(!probe.isFan()),
      full_turn_(probe.isFullTurn()),
      fine_(settings.heterogeneity_fine_m, hashOf(settings.heterogeneity_seed, kFine)),
      layers_(1, hashOf(settings.heterogeneity_seed, kLayers)) {}

// Coordinates in which layers are one unit thick along the beam and one wide across it.
Vec3f Heterogeneity::inLayers(Vec3f place_m) const {
  const Vec3d p = toDouble(place_m);
  const double across_m = linear_ ? p.x - p.z * tangent_ : middle_m_ * std::atan2(p.x, p.z);
  const double along_m = linear_ ? p.z * std::hypot(1, tangent_) : std::hypot(p.x, p.z);
  return toFloat({across_m / extent_m_, p.y / extent_m_, along_m * per_thickness_});
}

// Over a full turn, the last quarter passes over to the pattern at the seam's other side. Weights
// whose squares sum to 1 keep the variance.
double Heterogeneity::layersAt(Vec3f place_m) {
  constexpr double kQuarter = std::numbers::pi / 2;
  const Vec3f at = inLayers(place_m);
  const double own = layers_.at(at);
  const double angle = full_turn_ ? std::atan2(place_m.x, place_m.z) : 0;
  if (angle <= kQuarter) return own;
  const double turn = 2 * std::numbers::pi * middle_m_ / extent_m_;
  const double beyond = layers_.at(at - Vec3f{static_cast<float>(turn), 0, 0});
  return std::cos(angle - kQuarter) * own + std::sin(angle - kQuarter) * beyond;
}

double Heterogeneity::at(Vec3f place_m) {
  const double n = (fine_.at(place_m) + layersAt(place_m)) / std::numbers::sqrt2;
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
  NearestOnSurface endocardium, epicardium;
  Vec3d axis;
};

TissueStrength::TissueStrength(const Scene& scene, const EffectPlan& plan, const MeshMotion& motion,
                               const MotionField& field)
    : settings_(scene.speckle), probe_(scene.probe) {
  if (!plan.heterogeneity) settings_.heterogeneity_db = 0;
  const auto wall = structureOf(scene, Role::lv_wall), cavity = structureOf(scene, Role::lv_cavity);
  if (!plan.anisotropy || !wall || !cavity) return;
  const auto atrium = structureOf(scene, Role::la), valve = structureOf(scene, Role::mitral_valve);
  const auto base = valve ? valve : atrium;
  SurfaceFrame frame;
  motion.positionsAt(field.referencePhase(), std::array{*wall, *cavity, base.value_or(*wall)},
                     frame);
  const std::vector<Vec3f>& inner = frame.positions_m[index(*cavity)];
  wall_ = std::make_unique<const Wall>(Wall{
      static_cast<std::uint16_t>(index(field.groupOf(*wall))),
      NearestOnSurface(motion.surfaces()[index(*cavity)].triangles, inner),
      NearestOnSurface(motion.surfaces()[index(*wall)].triangles, frame.positions_m[index(*wall)]),
      longAxis(inner, base ? std::span<const Vec3f>(frame.positions_m[index(*base)])
                           : std::span<const Vec3f>())});
}

TissueStrength::~TissueStrength() = default;

void TissueStrength::amplitudes(std::span<const Vec3f> reference_m, std::uint16_t group, bool blood,
                                std::span<float> out) const {
  const Vec3d parallel = lineGeometry(probe_, probe_.lines / 2).direction;
  const auto heterogeneity =
      heterogeneities_.borrow([&] { return std::make_unique<Heterogeneity>(settings_, probe_); });
  for (std::size_t i = 0; i < out.size(); ++i) {
    double factor =
        blood || settings_.heterogeneity_db == 0 ? 1 : heterogeneity->at(reference_m[i]);
    if (wall_ && group == wall_->group) {
      const Vec3d p = toDouble(reference_m[i]), in = wall_->endocardium.to(reference_m[i]),
                  out_m = wall_->epicardium.to(reference_m[i]);
      const double inside = std::sqrt(dot(p - in, p - in)),
                   outside = std::sqrt(dot(p - out_m, p - out_m));
      const Vec3d beam = !probe_.isFan() ? parallel : unitOf(p);
      factor *=
          fibreFactor(fibreAt(unitOf(out_m - in), wall_->axis,
                              inside / std::max(inside + outside, 1e-9), settings_.helix_angle_rad),
                      beam, settings_.anisotropy_db);
    }
    out[i] = static_cast<float>(std::sqrt(factor));
  }
}

}  // namespace echocine
