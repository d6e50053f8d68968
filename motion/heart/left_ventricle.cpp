#include "motion/heart/left_ventricle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "motion/heart/meridian.h"
#include "motion/heart/segments.h"
#include "motion/heart/solve.h"
#include "motion/heart/units.h"

namespace echocine::heart {
namespace {

// The tables of the shape, over zeta: shares of the length from the mitral ring (0) to the apex (1)
// at end-diastole. Our choice, drawn after one heart fitted to cine MR; below 0 lies the
// outflow tract under the aortic valve.
const Meridian& outline() {
  static const Meridian table({{-0.06, 0},
                               {-0.05, 0.022},
                               {-0.03, 0.042},
                               {0, 0.056},
                               {0.05, 0.068},
                               {0.10, 0.081},
                               {0.20, 0.102},
                               {0.30, 0.1066},
                               {0.40, 0.0965},
                               {0.50, 0.083},
                               {0.60, 0.0665},
                               {0.70, 0.0470},
                               {0.80, 0.0298},
                               {0.90, 0.0163},
                               {0.95, 0.0093},
                               {1, 0}});
  return table;
}
const MonotoneCubic& centreX() {
  static const MonotoneCubic table({{-0.06, -0.03},
                                    {0, -0.01},
                                    {0.1, 0.008},
                                    {0.2, 0.035},
                                    {0.3, 0.054},
                                    {0.4, 0.066},
                                    {0.6, 0.056},
                                    {0.8, 0.043},
                                    {0.9, 0.023},
                                    {1, 0}});
  return table;
}
const MonotoneCubic& centreY() {
  static const MonotoneCubic table({{-0.06, 0.15},
                                    {0, 0.105},
                                    {0.05, 0.083},
                                    {0.1, 0.060},
                                    {0.2, 0.030},
                                    {0.3, 0.028},
                                    {0.4, 0.038},
                                    {0.7, 0.040},
                                    {0.9, 0.022},
                                    {1, 0}});
  return table;
}
// sqrt of the semi-axes' ratio, x to y.
const MonotoneCubic& flattening() {
  static const MonotoneCubic table({{-0.06, 0.90},
                                    {0, 0.94},
                                    {0.1, 1.04},
                                    {0.2, 1.05},
                                    {0.35, 1.0},
                                    {0.5, 1.01},
                                    {0.65, 1.06},
                                    {0.85, 1.05},
                                    {1, 1}});
  return table;
}
// How much of the contraction each height takes part in: the ring is stiff.
const MonotoneCubic& participation() {
  static const MonotoneCubic table(
      {{-0.06, 0.05}, {0, 0.10}, {0.05, 0.22}, {0.1, 0.45}, {0.2, 0.82}, {0.3, 1}, {1, 1}});
  return table;
}
// Wall thickness over that of the septum: thin over the valves, thinner at the apex.
const MonotoneCubic& thickness() {
  static const MonotoneCubic table({{-0.06, 0.22},
                                    {-0.02, 0.25},
                                    {0.03, 0.6},
                                    {0.10, 0.92},
                                    {0.2, 1},
                                    {0.65, 0.96},
                                    {0.85, 0.78},
                                    {1, 0.58}});
  return table;
}
// The free wall is thinner than the septum.
double thicknessAbout(double phi_rad) {
  return 0.93 + 0.07 * std::cos(phi_rad - 150 * kDegree);
}

// Of the apex towards the base at end-systole, of the length.
constexpr double kApexRise = 0.035;

constexpr double kLargestStrain = 0.85, kWallDrift = 0.01;  // our choice
constexpr double kVolumeTolerance = 1e-5;  // of solved volumes, as a share of the end-diastolic one

// What the apex turns by is shared with the base, which turns the other way; our choice, after the
// usual description of twist (apex counter-clockwise seen from below, base clockwise and less).
double twistShare(double zeta) {
  return zeta - 0.3;
}

// Of the outline, from the apex.
double shareOf(Vec3d direction) {
  return std::acos(std::clamp(direction.z, -1.0, 1.0)) / std::numbers::pi;
}

}  // namespace

LeftVentricle::LeftVentricle(const Parameters& parameters) : parameters_(parameters) {
  edv_m3_ = parameters.edv_ml * kMillilitre;
  // Volume = length^3 girth^2 outline().volume(); sphericity = 2 girth outline().widest().
  if (parameters.lv_length_mm) {
    length_ = *parameters.lv_length_mm * kMillimetre;
    girth_ = std::sqrt(edv_m3_ / (std::pow(length_, 3) * outline().volume()));
  } else {
    girth_ = parameters.sphericity / (2 * outline().widest());
    length_ = std::cbrt(edv_m3_ / (girth_ * girth_ * outline().volume()));
  }
  apex_z_ = length_;
  cavity_gauge_.emplace(kFrequency, [this](Vec3d d) { return cavityPoint(d); });
  outer_gauge_.emplace(kFrequency, [this](Vec3d d) { return wallPoint(d); });
  wall_m3_ = outerVolume() - cavityVolume();

  // The strain of a beat whose segments all do their share at once.
  for (int s = 0; s < kSegments; ++s) contraction_.segments[s] = parameters.segments[s].amplitude;
  moveAxis(1);
  const double esv_m3 = edv_m3_ * (1 - parameters.ejection_fraction);
  const auto emptied = [this](double strain) {
    strain_ = strain;
    return -cavityVolume();
  };
  const double least = 1 + emptied(0) / edv_m3_, most = 1 + emptied(kLargestStrain) / edv_m3_;
  const double ef = parameters.ejection_fraction;
  if (!(ef >= least && ef <= most))
    throw SceneError(fmt::format(
        "ef: {:g} is not possible with mapse {:.3g} mm and these segments; accepted are {:.3f} to "
        "{:.3f}, or change those",
        ef, parameters.mapse_mm, std::max(least, 0.0), most));
  strain_ = solve(0, kLargestStrain, -esv_m3, kVolumeTolerance * edv_m3_, emptied);
  contract({});
}

double LeftVentricle::ejectionFractionOf(const Parameters& parameters) {
  Parameters healthy = parameters;
  for (Segment& segment : healthy.segments) segment = {};
  LeftVentricle ventricle(healthy);  // finds the strain
  for (int s = 0; s < kSegments; ++s)
    ventricle.contraction_.segments[s] = parameters.segments[s].amplitude;
  ventricle.moveAxis(1);
  ventricle.correction_ = 0;
  return 1 - ventricle.cavityVolume() / ventricle.edv_m3_;
}

void LeftVentricle::moveAxis(double ejected) {
  ring_z_ = parameters_.mapse_mm * kMillimetre * ejected;
  apex_z_ = length_ * (1 - kApexRise * ejected);
  twist_rad_ = parameters_.twist_deg * kDegree * ejected;
}

void LeftVentricle::contract(const Contraction& contraction) {
  contraction_ = contraction;
  moveAxis(contraction.ejected);
  const double volume_m3 = edv_m3_ * (1 - parameters_.ejection_fraction * contraction.ejected);
  const auto emptied = [this](double correction) {
    correction_ = correction;
    return -cavityVolume();
  };
  correction_ = solve(-0.5, 0.5, -volume_m3, kVolumeTolerance * edv_m3_, emptied);
  const double cavity_m3 = -emptied(correction_);
  const auto outer = [this](double factor) {
    thickening_ = factor;
    return outerVolume();
  };
  thickening_ = solve(0.5, 2, cavity_m3 + wall_m3_, kVolumeTolerance * edv_m3_, outer);
  const double wall_m3 = outer(thickening_) - cavity_m3;
  if (std::abs(cavity_m3 - volume_m3) > 1e-3 * edv_m3_)
    throw SceneError(fmt::format(
        "segments: with these delays the left ventricle cannot hold {:.4g} mL at {:.0f} % of its "
        "ejection; shorten them",
        volume_m3 / kMillilitre, 100 * contraction.ejected));
  if (std::abs(wall_m3 - wall_m3_) > kWallDrift * wall_m3_)
    throw SceneError(
        fmt::format("wall-thickness: the wall's {:.4g} mL cannot be kept at {:.0f} % of the "
                    "ejection; choose another wall-thickness or ef",
                    wall_m3_ / kMillilitre, 100 * contraction.ejected));
}

LeftVentricle::Material LeftVentricle::materialOf(Vec3d direction) const {
  const Meridian::Point at = outline().at(shareOf(direction));
  // Turned by an odd angle, so that no edge of the mesh lies in an imaging plane.
  constexpr double kTurn_rad = 0.3;
  return {std::atan2(direction.y, direction.x) + kTurn_rad, at.zeta, at.rho};
}

LeftVentricle::Material LeftVentricle::materialAt(double phi_rad, double zeta) const {
  return {phi_rad - twist_rad_ * twistShare(zeta), zeta, outline().rhoAt(zeta)};
}

double LeftVentricle::radialShare(const Material& at) const {
  const auto shares = segmentShares(at.phi_rad, at.zeta);
  double inward = 0;
  for (int s = 0; s < kSegments; ++s) inward += shares[s] * contraction_.segments[s];
  return 1 - participation()(at.zeta) * (strain_ * inward + correction_);
}

Vec3d LeftVentricle::placed(const Material& at) const {
  const double phi_rad = at.phi_rad + twist_rad_ * twistShare(at.zeta);
  const double flat = flattening()(at.zeta);
  const double radius = girth_ * length_ * at.rho * radialShare(at);
  const double offset = girth_ * (apex_z_ - ring_z_);
  return {offset * centreX()(at.zeta) + radius * flat * std::cos(phi_rad),
          offset * centreY()(at.zeta) + radius / flat * std::sin(phi_rad),
          std::lerp(ring_z_, apex_z_, at.zeta)};
}

Vec3d LeftVentricle::cavityPoint(Vec3d direction) const {
  return placed(materialOf(direction));
}

Vec3d LeftVentricle::cavityAt(double phi_rad, double zeta) const {
  return placed(materialAt(phi_rad, zeta));
}

double LeftVentricle::wallThicknessAt(double phi_rad, double zeta) const {
  return wallThickness(materialAt(phi_rad, zeta));
}

// Muscle keeps its volume: (r + h)^2 - r^2, the wall's section about the axis, grows as the length
// shrinks, r being the cavity's radius and h the wall's thickness.
double LeftVentricle::wallThickness(const Material& at) const {
  const double h0 = parameters_.wall_thickness_mm * kMillimetre * thickness()(at.zeta) *
                    thicknessAbout(at.phi_rad);
  const double r0 = girth_ * length_ * at.rho;
  const double r = r0 * radialShare(at);
  const double section = h0 * (2 * r0 + h0) * length_ / (apex_z_ - ring_z_);
  const double grown = std::sqrt(r * r + section) - r;
  return thickening_ * std::lerp(h0, grown, participation()(at.zeta));
}

// The wall grows along normals of the outline turned about a straight axis, which is convex: those
// of the cavity itself meet where the septum is hollow.
Vec3d LeftVentricle::wallPoint(Vec3d direction) const {
  const Material at = materialOf(direction);
  constexpr double kStep = 0.015;  // of the outline
  const double share = shareOf(direction);
  const Meridian::Point before = outline().at(std::abs(share - kStep));
  const Meridian::Point after = outline().at(1 - std::abs(1 - share - kStep));
  // Past either end the outline comes back on the other side.
  const double rho_before = share < kStep ? -before.rho : before.rho;
  const double rho_after = share > 1 - kStep ? -after.rho : after.rho;
  const double outward = before.zeta - after.zeta, apexward = girth_ * (rho_after - rho_before);
  const double phi_rad = at.phi_rad + twist_rad_ * twistShare(at.zeta);
  const Vec3d normal =
      normalised(Vec3d{outward * std::cos(phi_rad), outward * std::sin(phi_rad), apexward});
  return placed(at) + wallThickness(at) * normal;
}

double LeftVentricle::cavityVolume() const {
  return (*cavity_gauge_)([this](Vec3d d) { return cavityPoint(d); });
}

double LeftVentricle::outerVolume() const {
  return (*outer_gauge_)([this](Vec3d d) { return wallPoint(d); });
}

}  // namespace echocine::heart
