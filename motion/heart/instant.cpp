#include "motion/heart/instant.h"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "core/error.h"
#include "core/stop.h"
#include "motion/heart/heart_units.h"
#include "motion/heart/smooth.h"
#include "motion/heart/solve.h"

// Positions without a source are our choice, modelled on hearts segmented from CT and fitted to
// cine MR. l is the length of the left ventricle at end-diastole.

namespace echocine::heart {
namespace {

constexpr double kBalloonTolerance = 1e-5;  // of volumes that are solved for
constexpr double kClearance_m = 3e-4;       // between a chamber and the wall of its neighbour

// Outlines over zeta, 0 at the ring and 1 at the far end, in squared shares of the axis' length.
const Meridian& atriumOutline() {
  static const Meridian table({{-0.16, 0},
                               {-0.12, 0.032},
                               {-0.06, 0.070},
                               {0, 0.100},
                               {0.10, 0.118},
                               {0.30, 0.172},
                               {0.55, 0.200},
                               {0.78, 0.155},
                               {0.92, 0.070},
                               {1, 0}});
  return table;
}
const Meridian& papillaryOutline() {
  static const Meridian table(
      {{-0.15, 0}, {-0.08, 0.030}, {0.2, 0.042}, {0.6, 0.034}, {0.9, 0.016}, {1, 0}});
  return table;
}

ValveRing ringAt(Vec3d centre, Vec3d flow, double radius_m) {
  ValveRing ring;
  ring.centre = centre;
  ring.flow = normalised(flow);
  constexpr Vec3d kSide{1, 0, 0};
  ring.side = normalised(kSide - dot(kSide, ring.flow) * ring.flow);
  ring.up = cross(ring.flow, ring.side);
  ring.radius_m = radius_m;
  return ring;
}

double atrialVolume(double largest_ml, double filled) {
  constexpr double kEmptied = 0.55;  // of the largest volume, in health
  return largest_ml * (1 - kEmptied * (1 - filled)) * kMillilitre;
}

double atrialAxis(double largest_ml) {
  return 0.044 * std::cbrt(largest_ml / 55);
}

std::vector<Bearing> atriumBearings(std::span<const Vec3d> directions) {
  std::vector<Bearing> bearings;
  for (const Vec3d d : directions) bearings.push_back(bearingOf(atriumOutline(), d));
  return bearings;
}

// Four directions beside each one, for its normal.
std::vector<Vec3d> besides(std::span<const Vec3d> directions) {
  constexpr double kStep = 0.05;
  std::vector<Vec3d> all;
  for (const Vec3d direction : directions) {
    const Vec3d helper = std::abs(direction.z) < 0.7 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
    const Vec3d u = normalised(cross(helper, direction)), v = cross(direction, u);
    for (const Vec3d tangent : {u, v})
      for (const double step : {kStep, -kStep})
        all.push_back(normalised(direction + step * tangent));
  }
  return all;
}

struct AtriumMesh {
  std::vector<Bearing> bearings, fine, beside;
};
const AtriumMesh& atriumMesh() {
  static const std::vector<Vec3d>& directions =
      geodesicSphere(Instant::kAtriumFrequency).directions;
  static const AtriumMesh mesh{
      atriumBearings(directions),
      atriumBearings(geodesicSphere(2 * Instant::kAtriumFrequency).directions),
      atriumBearings(besides(directions))};
  return mesh;
}

// Walls grow along the normals of the undented chamber, which never intersect.
std::vector<Vec3d> thickened(std::vector<Vec3d> points, const Balloon& atrium, double thickness_m) {
  const std::vector<Vec3d> beside = atrium.points(atriumMesh().beside);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d* const at = &beside[4 * i];
    points[i] = points[i] + thickness_m * normalised(cross(at[0] - at[1], at[2] - at[3]));
  }
  return points;
}

// Sets the girth of a balloon so that it encloses a volume after yielding to its neighbours.
// Returns its points.
template <typename GiveWay>
std::vector<Vec3d> inflate(Balloon& balloon, double volume_m3, const char* key,
                           const GiveWay& giveWay) {
  const auto pointsOf = [&](const std::vector<Bearing>& bearings) {
    std::vector<Vec3d> points = balloon.points(bearings);
    giveWay(points);
    return points;
  };
  const AtriumMesh& mesh = atriumMesh();
  const VolumeGauge gauge(Instant::kAtriumFrequency, pointsOf(mesh.bearings), pointsOf(mesh.fine));
  std::vector<Vec3d> points;
  double reached = 0;
  const auto volume = [&](double girth) {
    balloon.girth = girth;
    points = pointsOf(mesh.bearings);
    return reached = gauge(points);
  };
  solve(0.2, 4, volume_m3, kBalloonTolerance * volume_m3, volume);
  if (std::abs(reached - volume_m3) > 0.01 * volume_m3)
    throw SceneError(
        fmt::format("{}: an atrium of {:.3g} mL does not fit this heart; it would have {:.3g}", key,
                    volume_m3 / kMillilitre, reached / kMillilitre));
  return points;
}

}  // namespace

Instant::Instant(const Parameters& parameters, const LeftVentricle& at_rest, const State& now)
    : state_(now), left_(at_rest) {
  checkpoint();  // the first computation of every heart
  left_.contract(now.left);
  epicardium_.emplace(left_);
  checkpoint();
  const double scale_m = kMillimetre * parameters.body_scale;
  walls_ = {4 * scale_m * (1 + 0.25 * now.rv_ejected), 2 * scale_m, 1.8 * scale_m};
  buildRightVentricle(parameters);
  buildVessels();
  buildAtria(parameters);
  buildPapillaries();
}

void Instant::buildRightVentricle(const Parameters& parameters) {
  right_.emplace(left_, *epicardium_, state_.rv_ejected);
  const double stroke_ml = parameters.edv_ml * parameters.ejection_fraction;
  const double volume_m3 = (parameters.rv_edv_ml - stroke_ml * state_.rv_ejected) * kMillilitre;
  const double l = left_.length();
  constexpr int kFrequency = RightVentricle::kFrequency;
  const std::vector<RightVentricle::Spoke> spokes = right_->spokes(kFrequency);
  right_->arch(0.3 * l);
  const VolumeGauge gauge(kFrequency, right_->cavityPoints(spokes),
                          right_->cavityPoints(right_->spokes(2 * kFrequency)));
  double reached = 0;
  const auto volume = [&](double height_m) {
    right_->arch(height_m);
    return reached = gauge(right_->cavityPoints(spokes));
  };
  solve(0.02 * l, 1.5 * l, volume_m3, kBalloonTolerance * volume_m3, volume);
  if (std::abs(reached - volume_m3) > 0.01 * volume_m3)
    throw SceneError(
        fmt::format("rv-edv: a right ventricle of {:.3g} mL does not fit around a left one of "
                    "{:.3g} mm length; it would have {:.3g} mL",
                    volume_m3 / kMillilitre, l / kMillimetre, reached / kMillilitre));
}

// The great vessels start within their ventricle and leave away from the apex.
void Instant::buildVessels() {
  const double l = left_.length();
  const Vec3d descent{0, 0, left_.ringZ()};
  const auto at = [l](double x, double y, double z) { return Vec3d{x * l, y * l, z * l}; };

  const Vec3d aortic_flow = normalised(Vec3d{-0.44, 0.46, -0.77});
  const Vec3d aortic = at(-0.135, 0.262, 0) + descent;
  const double root_m = 0.122 * l;
  aorta_.emplace(
      std::vector<Tube::Station>{{aortic - 0.10 * l * aortic_flow, 0.95 * root_m},
                                 {aortic, root_m},
                                 {aortic + 0.14 * l * aortic_flow, 1.38 * root_m},  // sinuses
                                 {aortic + 0.30 * l * aortic_flow, 1.14 * root_m},
                                 {at(-0.36, 0.545, -0.36) + 0.5 * descent, 1.25 * root_m},
                                 {at(-0.42, 0.66, -0.56) + 0.2 * descent, 1.28 * root_m},
                                 {at(-0.44, 0.74, -0.80), 1.25 * root_m}});
  constexpr double kInWall_m = 4e-4;  // leaflets are hinged within the wall
  aortic_ = ringAt(aortic, aortic_flow, root_m + kInWall_m);

  const Vec3d pulmonary_flow = normalised(Vec3d{0.10, 0.12, -0.95});
  const Vec3d pulmonary = right_->outflow() + 0.04 * l * pulmonary_flow;
  const Vec3d moved = pulmonary - at(-0.08, 0.58, -0.085);  // since end-diastole, about
  const double trunk_m = 0.125 * l;
  pulmonary_artery_.emplace(
      std::vector<Tube::Station>{{pulmonary - 0.12 * l * pulmonary_flow, 0.95 * trunk_m},
                                 {pulmonary, trunk_m},
                                 {pulmonary + 0.16 * l * pulmonary_flow, 1.2 * trunk_m},
                                 {at(-0.05, 0.60, -0.40) + 0.8 * moved, 1.1 * trunk_m},
                                 {at(0.02, 0.57, -0.56) + 0.5 * moved, 1.05 * trunk_m},
                                 {at(0.12, 0.50, -0.70) + 0.2 * moved, trunk_m}});
  pulmonary_ = ringAt(pulmonary, pulmonary_flow, trunk_m + kInWall_m);
}

// The roofs of the atria are fixed, while the rings descend and elongate the atria.
void Instant::buildAtria(const Parameters& parameters) {
  const double l = left_.length(), mapse_m = parameters.mapse_mm * kMillimetre;
  constexpr double kRingZone = 0.35;

  mitral_ = ringAt({0, 0, left_.ringZ()}, {0, 0, 1}, 0.185 * l);
  la_.outline = &atriumOutline();
  la_.ring = mitral_.centre + Vec3d{-0.005 * l, -0.01 * l, 0};
  la_.roof = {-0.07 * l, -0.07 * l, mapse_m - atrialAxis(parameters.la_volume_ml)};
  la_.side = {1, 0, 0};
  la_.aspect = 1.08;
  la_.ring_zone = kRingZone;
  la_.bow = {-0.03 * l, -0.03 * l, 0};
  const double clear_of_aorta_m = walls_.vessel_m + kClearance_m;
  const auto inflateLeft = [&] {
    la_points_ =
        inflate(la_, atrialVolume(parameters.la_volume_ml, state_.atria_filled), "la-volume",
                [&](std::vector<Vec3d>& points) { aorta_->pushOut(clear_of_aorta_m, points); });
  };
  inflateLeft();

  tricuspid_ = ringAt(right_->ringCentre(), right_->ringFlow(), right_->ringRadius());
  ra_.outline = &atriumOutline();
  ra_.ring = tricuspid_.centre;
  ra_.roof = {-0.56 * l, 0.02 * l,
              right_->restingRingZ() + 1.15 * mapse_m - atrialAxis(parameters.ra_volume_ml)};
  ra_.side = {1, 0, 0};
  ra_.aspect = 0.98;
  ra_.ring_zone = kRingZone;
  ra_.bow = {-0.03 * l, 0, 0};
  const auto inflateRight = [&] {
    ra_points_ = inflate(ra_, atrialVolume(parameters.ra_volume_ml, state_.atria_filled),
                         "ra-volume", [&](std::vector<Vec3d>& points) {
                           aorta_->pushOut(clear_of_aorta_m, points);
                           epicardium_->pushOut(kClearance_m, points);
                           la_.pushOut(walls_.atrium_m + kClearance_m, points);
                         });
  };
  inflateRight();
  joinAtria();
  inflateLeft();
  inflateRight();
}

// The septum between the atria is thin also while they are small: their axes bend towards each
// other until both chambers flatten against the left one's wall.
void Instant::joinAtria() {
  constexpr double kMiddle = 0.5, kFlattened_m = 5e-3, kLeftShare = 0.4, kRounding_m = 2e-3,
                   kMostBend = 0.35;
  const Vec3d left = la_.centre(kMiddle), right = ra_.centre(kMiddle);
  const Vec3d across{left.x - right.x, left.y - right.y, 0};
  const double apart_m = length(across) - la_.radiusTowards(right, kMiddle) -
                         ra_.radiusTowards(left, kMiddle) - walls_.atrium_m + kFlattened_m;
  // Small atria far apart keep their shape: a stronger bend would fold them.
  const double most_m =
      kMostBend * std::min(length(la_.roof - la_.ring), length(ra_.roof - ra_.ring));
  const double wanted_m = smoothMax(apart_m, 0, kRounding_m);
  const Vec3d bend = -smoothMax(-wanted_m, -most_m, kRounding_m) * normalised(across);
  la_.bow = la_.bow - kLeftShare * bend;
  ra_.bow = ra_.bow + (1 - kLeftShare) * bend;
}

// From the wall at mid-height towards the commissures of the mitral valve.
void Instant::buildPapillaries() {
  constexpr std::array<double, 2> kAngles_rad{5 * kDegree, 240 * kDegree};
  for (std::size_t i = 0; i < papillaries_.size(); ++i) {
    const Vec3d tip_wall = left_.cavityAt(kAngles_rad[i], 0.42);
    const Vec3d middle{0.3 * tip_wall.x, 0.3 * tip_wall.y, tip_wall.z};
    Balloon& muscle = papillaries_[i];
    muscle.outline = &papillaryOutline();
    muscle.ring = left_.cavityAt(kAngles_rad[i], 0.70);
    muscle.roof = tip_wall + 0.42 * (middle - tip_wall);
    muscle.side = {-std::sin(kAngles_rad[i]), std::cos(kAngles_rad[i]), 0};
  }
}

std::vector<Vec3d> Instant::leftAtrium(double thickness_m) const {
  return thickness_m == 0 ? la_points_ : thickened(la_points_, la_, thickness_m);
}

std::vector<Vec3d> Instant::rightAtrium(double thickness_m) const {
  return thickness_m == 0 ? ra_points_ : thickened(ra_points_, ra_, thickness_m);
}

std::vector<Vec3d> Instant::papillary(std::size_t number, const SphereMesh& sphere) const {
  std::vector<Bearing> bearings;
  for (const Vec3d d : sphere.directions) bearings.push_back(bearingOf(papillaryOutline(), d));
  return papillaries_[number].points(bearings);
}

}  // namespace echocine::heart
