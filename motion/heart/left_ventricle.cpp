#include "motion/heart/left_ventricle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "motion/heart/heart_indices.h"
#include "motion/heart/heart_units.h"
#include "motion/heart/solve.h"

namespace echocine::heart {
namespace {

constexpr double kLargestStrain = 0.85, kWallDrift = 0.01;  // our choice
constexpr double kLeastShare = 0.02;       // of a radius at end-diastole; our choice
constexpr double kVolumeTolerance = 1e-5;  // of solved volumes, as a share of the end-diastolic one

// The twist of the apex is shared with the base, which rotates the other way; our choice, after the
// usual description of twist (apex counter-clockwise seen from below, base clockwise and less).
double twistShare(double zeta) {
  return zeta - 0.3;
}

// exp(share M) p, with M = (e, e45; e45, -e) of the ellipticities: areas of sections stay. A share
// of the other sign turns normals as the same share moves points.
Vec3d stretched(Vec3d p, const SectionShape& shape, double share) {
  if (shape.ellipticity == 0 && shape.ellipticity_45 == 0) return p;
  const double a = share * shape.ellipticity, b = share * shape.ellipticity_45,
               k = std::hypot(a, b);
  if (k == 0) return p;
  const double even = std::cosh(k), odd = std::sinh(k) / k;
  return {even * p.x + odd * (a * p.x + b * p.y), even * p.y + odd * (b * p.x - a * p.y), p.z};
}

// All segments at the end of their inward motion.
Contraction contractionBy(const Parameters& parameters) {
  Contraction contraction{1, {}};
  for (int s = 0; s < kSegments; ++s) contraction.segments[s] = parameters.segments[s].amplitude;
  return contraction;
}

double taperOf(const Parameters& parameters) {
  return parameters.conicity ? std::log(*parameters.conicity / outlineConicity()) : 0;
}

double girthOf(double volume_m3, double length_m, const OutlineSize& outline) {
  return std::sqrt(volume_m3 / (std::pow(length_m, 3) * outline.volume));
}

}  // namespace

// Volume = length^3 girth^2 outline.volume; sphericity = 2 girth outline.widest.
double sphericityOf(const Parameters& parameters) {
  if (!parameters.lv_length_mm) return parameters.sphericity;
  const OutlineSize outline = outlineSize(taperOf(parameters));
  const double length_m = *parameters.lv_length_mm * kMillimetre;
  return 2 * girthOf(parameters.edv_ml * kMillilitre, length_m, outline) * outline.widest;
}

LeftVentricle::LeftVentricle(const Parameters& parameters) : parameters_(parameters) {
  edv_m3_ = parameters.edv_ml * kMillilitre;
  taper_ = taperOf(parameters);
  gradient_ = std::log(parameters.apical_motion);
  const OutlineSize outline = outlineSize(taper_);
  if (parameters.lv_length_mm) {
    length_ = *parameters.lv_length_mm * kMillimetre;
    girth_ = girthOf(edv_m3_, length_, outline);
  } else {
    girth_ = parameters.sphericity / (2 * outline.widest);
    length_ = std::cbrt(edv_m3_ / (girth_ * girth_ * outline.volume));
  }
  set({});
  cavity_gauge_.emplace(kFrequency, [this](Vec3d d) { return cavityPoint(d); });
  outer_gauge_.emplace(kFrequency, [this](Vec3d d) { return wallPoint(wallPlaceOf(d)); });
  wall_m3_ = (*outer_gauge_)(wallPoints()) - cavityVolume();

  // The strain of a beat in which all segments contract simultaneously.
  set(contractionBy(parameters));
  const double esv_m3 = edv_m3_ * (1 - parameters.ejection_fraction);
  const auto emptied = [this](double strain) {
    strain_ = strain;
    return -cavityVolume();
  };
  const double least = 1 + emptied(0) / edv_m3_, most = 1 + emptied(kLargestStrain) / edv_m3_;
  const double ef = parameters.ejection_fraction;
  if (!(ef >= least && ef <= most))
    throw SceneError(fmt::format(
        "ef: {:g} is not possible with mapse {:.3g} mm and these segments; accepted: {:.3f} to "
        "{:.3f}; or change mapse or the segments",
        ef, parameters.mapse_mm, std::max(least, 0.0), most));
  strain_ = solve(0, kLargestStrain, -esv_m3, kVolumeTolerance * edv_m3_, emptied);
  contract({});
}

double LeftVentricle::ejectionFractionOf(const Parameters& parameters) {
  Parameters healthy = parameters;
  for (Segment& segment : healthy.segments) segment = {};
  LeftVentricle ventricle(healthy);  // finds the strain
  ventricle.set(contractionBy(parameters));
  ventricle.correction_ = 0;
  return 1 - ventricle.cavityVolume() / ventricle.edv_m3_;
}

void LeftVentricle::set(const Contraction& contraction) {
  contraction_ = contraction;
  ring_z_ = parameters_.mapse_mm * kMillimetre * contraction.ejected;
  apex_z_ = length_ * (1 - kApexRise * contraction.ejected);
  twist_rad_ = parameters_.twist_deg * kDegree * contraction.ejected;
  turned_.clear();
  for (const WallPlace& at : meshPlaces()) turned_.push_back(turnedOf(at));
}

void LeftVentricle::contract(const Contraction& contraction) {
  set(contraction);
  const double volume_m3 = edv_m3_ * (1 - parameters_.ejection_fraction * contraction.ejected);
  double cavity_m3 = 0;
  const auto emptied = [&](double correction) {
    correction_ = correction;
    cavity_m3 = cavityVolume();
    return -cavity_m3;
  };
  solve(-0.5, 0.5, -volume_m3, kVolumeTolerance * edv_m3_, emptied);
  const std::vector<Grown> grown = grownPlaces();
  std::vector<Vec3d> points(grown.size());
  double outer_m3 = 0;
  const auto outer = [&](double factor) {
    thickening_ = factor;
    std::transform(grown.begin(), grown.end(), points.begin(),
                   [factor](const Grown& g) { return g.from + factor * g.thickness_m * g.normal; });
    return outer_m3 = (*outer_gauge_)(points);
  };
  solve(0.5, 2, cavity_m3 + wall_m3_, kVolumeTolerance * edv_m3_, outer);
  const double wall_m3 = outer_m3 - cavity_m3;
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

LeftVentricle::Turned LeftVentricle::turnedOf(const WallPlace& at) const {
  const double phi_rad = at.phi_rad + twist_rad_ * twistShare(at.zeta);
  double inward = 0;
  for (std::size_t i = 0; i < at.segment.size(); ++i)
    inward += at.share[i] * contraction_.segments[at.segment[i]];
  if (gradient_ != 0) inward *= std::exp(gradient_ * at.lean);
  return {std::cos(phi_rad), std::sin(phi_rad), inward, widerAt(at.lean), thickerAt(at)};
}

double LeftVentricle::widerAt(double lean) const {
  return taper_ == 0 ? 1 : std::exp(taper_ * lean);
}

double LeftVentricle::thickerAt(const WallPlace& at) const {
  const SectionShape& s = parameters_.section;
  if (s.apical_thickness == 1 && s.lateral_thickness == 1 && s.anterior_thickness == 1) return 1;
  return std::pow(s.apical_thickness, at.lean) *
         std::pow(s.lateral_thickness, 0.5 * (1 + std::cos(at.phi_rad))) *
         std::pow(s.anterior_thickness, 0.5 * std::sin(at.phi_rad));
}

double LeftVentricle::radius(const WallPlace& at, const Turned& turned) const {
  const double share = 1 - at.participation * (strain_ * turned.inward + correction_);
  return girth_ * length_ * at.rho * turned.wider * std::max(share, kLeastShare);
}

Vec3d LeftVentricle::placed(const WallPlace& at, const Turned& turned) const {
  const double r = radius(at, turned);
  const double length = apex_z_ - ring_z_, offset = girth_ * length;
  const SectionShape& s = parameters_.section;
  const Vec3d spoke =
      stretched({r * at.flat * turned.cos_phi, r / at.flat * turned.sin_phi, 0}, s, 0.5 * at.oval);
  return {offset * at.centre_x + length * s.bow_lateral * at.bow + spoke.x,
          offset * at.centre_y + length * s.bow_anterior * at.bow + spoke.y,
          std::lerp(ring_z_, apex_z_, at.zeta)};
}

WallPlace LeftVentricle::untwisted(double phi_rad, double zeta) const {
  return wallPlaceAt(phi_rad - twist_rad_ * twistShare(zeta), zeta);
}

Vec3d LeftVentricle::cavityPoint(Vec3d direction) const {
  const WallPlace at = wallPlaceOf(direction);
  return placed(at, turnedOf(at));
}

Vec3d LeftVentricle::cavityAt(double phi_rad, double zeta) const {
  const WallPlace at = untwisted(phi_rad, zeta);
  return placed(at, turnedOf(at));
}

double LeftVentricle::wallThicknessAt(double phi_rad, double zeta) const {
  const WallPlace at = untwisted(phi_rad, zeta);
  return thickening_ * unscaledThickness(at, turnedOf(at));
}

// Muscle keeps its volume: (r + h)^2 - r^2, the wall's section about the axis, grows as the length
// shrinks, r being the cavity's radius and h the wall's thickness.
double LeftVentricle::unscaledThickness(const WallPlace& at, const Turned& turned) const {
  const double h0 = parameters_.wall_thickness_mm * kMillimetre * at.thickness *
                    at.thickness_about * turned.thicker;
  const double r0 = girth_ * length_ * at.rho * turned.wider;
  const double r = radius(at, turned);
  const double section = h0 * (2 * r0 + h0) * length_ / (apex_z_ - ring_z_);
  const double grown = std::sqrt(r * r + section) - r;
  return std::lerp(h0, grown, at.participation);
}

// The wall grows along normals of the outline rotated about a straight axis, which is convex. The
// cavity's own normals would intersect where the septum is concave.
LeftVentricle::Grown LeftVentricle::grown(const WallPlace& at, const Turned& turned) const {
  const double rise =
      at.after.rho * widerAt(at.after.lean) - at.before.rho * widerAt(at.before.lean);
  const Vec3d about = stretched({at.outward * turned.cos_phi, at.outward * turned.sin_phi, 0},
                                parameters_.section, -0.5 * at.oval);
  const Vec3d normal = normalised(about + Vec3d{0, 0, girth_ * rise});
  return {placed(at, turned), normal, unscaledThickness(at, turned)};
}

Vec3d LeftVentricle::wallPoint(const WallPlace& at) const {
  const Grown g = grown(at, turnedOf(at));
  return g.from + thickening_ * g.thickness_m * g.normal;
}

std::vector<LeftVentricle::Grown> LeftVentricle::grownPlaces() const {
  std::vector<Grown> all;
  for (std::size_t i = 0; i < turned_.size(); ++i)
    all.push_back(grown(meshPlaces()[i], turned_[i]));
  return all;
}

std::vector<Vec3d> LeftVentricle::cavityPoints() const {
  std::vector<Vec3d> points;
  points.reserve(turned_.size());
  for (std::size_t i = 0; i < turned_.size(); ++i)
    points.push_back(placed(meshPlaces()[i], turned_[i]));
  return points;
}

std::vector<Vec3d> LeftVentricle::wallPoints() const {
  std::vector<Vec3d> points;
  for (const Grown& g : grownPlaces())
    points.push_back(g.from + thickening_ * g.thickness_m * g.normal);
  return points;
}

double LeftVentricle::cavityVolume() const {
  return (*cavity_gauge_)(cavityPoints());
}

}  // namespace echocine::heart
