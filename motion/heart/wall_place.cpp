#include "motion/heart/wall_place.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/check.h"
#include "core/monotone_cubic.h"
#include "motion/heart/control_mesh.h"
#include "motion/heart/heart_units.h"
#include "motion/heart/segment_shares.h"

namespace echocine::heart {
namespace {

// The tables of the shape, over zeta: relative to the length from the mitral ring (0) to the apex
// (1) at end-diastole. Our choice, modelled on one heart fitted to cine MR; below 0 is the outflow
// tract under the aortic valve.
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
// Participation of each height in the contraction: the ring is stiff.
const MonotoneCubic& participation() {
  static const MonotoneCubic table(
      {{-0.06, 0.05}, {0, 0.10}, {0.05, 0.22}, {0.1, 0.45}, {0.2, 0.82}, {0.3, 1}, {1, 1}});
  return table;
}
// Wall thickness relative to the septum: thin at the valves, thinner at the apex.
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

double bowOf(double zeta) {
  return zeta > 0 ? std::sin(std::numbers::pi * zeta) : 0;
}

double ovalOf(double zeta) {
  const double t = std::clamp(zeta / kOvalHeight, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Properties of a place that do not depend on its direction.
WallPlace placeOf(double phi_rad, double zeta, double rho) {
  WallPlace place{phi_rad,
                  zeta,
                  rho,
                  centreX()(zeta),
                  centreY()(zeta),
                  flattening()(zeta),
                  participation()(zeta),
                  thickness()(zeta),
                  thicknessAbout(phi_rad),
                  0,
                  leanOf(zeta),
                  bowOf(zeta),
                  ovalOf(zeta),
                  {},
                  {},
                  {},
                  {}};
  const std::array<double, kSegments> shares = segmentShares(phi_rad, zeta);
  std::size_t count = 0;
  for (std::size_t s = 0; s < kSegments; ++s) {
    if (shares[s] == 0) continue;
    CHECK_LT(count, place.share.size());  // two of each of two rings
    place.segment[count] = static_cast<std::uint8_t>(s);
    place.share[count++] = shares[s];
  }
  return place;
}

// Size of a tapered outline over that of the table's: logarithms, and their derivatives by the
// taper.
struct TaperedSize {
  double log_volume, volume_slope, log_widest, widest_slope;
};
constexpr double kLeastTaper = -2, kMostTaper = 1, kTapersPerUnit = 64;

TaperedSize taperedSize(double taper) {
  constexpr int kPlaces = 512;  // dense where the outline closes
  const double low = wallOutline().lowest(), high = 1;
  double volume = 0, own = 0, moment = 0, widest = 0, own_widest = 0;
  TaperedSize size{};
  for (int i = 1; i < kPlaces; ++i) {
    const double angle = std::numbers::pi * i / kPlaces;
    const double zeta = 0.5 * (low + high) + 0.5 * (high - low) * std::cos(angle);
    const double rho = wallOutline().rhoAt(zeta), lean = leanOf(zeta);
    const double wider = rho * std::exp(taper * lean);
    own += rho * rho * std::sin(angle);
    volume += wider * wider * std::sin(angle);
    moment += 2 * lean * wider * wider * std::sin(angle);
    own_widest = std::max(own_widest, rho);
    if (wider > widest) widest = wider, size.widest_slope = lean;
  }
  size.log_volume = std::log(volume / own);
  size.volume_slope = moment / volume;
  size.log_widest = std::log(widest / own_widest);
  return size;
}

std::vector<TaperedSize> taperedSizes() {
  std::vector<TaperedSize> all;
  const int count = static_cast<int>((kMostTaper - kLeastTaper) * kTapersPerUnit);
  for (int i = 0; i <= count; ++i) all.push_back(taperedSize(kLeastTaper + i / kTapersPerUnit));
  return all;
}

// Cubic between values a and b with slopes by t at 0 and 1: its value and slope at t.
std::pair<double, double> hermite(double a, double slope_a, double b, double slope_b, double t) {
  const double c = 3 * (b - a) - 2 * slope_a - slope_b, d = slope_a + slope_b - 2 * (b - a);
  return {a + t * (slope_a + t * (c + t * d)), slope_a + t * (2 * c + 3 * t * d)};
}

}  // namespace

const Meridian& wallOutline() {
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

double leanOf(double zeta) {
  return std::sin(std::numbers::pi * (zeta - 0.5));
}

double outlineConicity() {
  static const double ratio =
      wallOutline().rhoAt(kApicalHeight) / wallOutline().rhoAt(kBasalHeight);
  return ratio;
}

OutlineSize outlineSize(double taper) {
  static const std::vector<TaperedSize> table = taperedSizes();
  const double step = (std::clamp(taper, kLeastTaper, kMostTaper) - kLeastTaper) * kTapersPerUnit;
  const std::size_t i = std::min(static_cast<std::size_t>(step), table.size() - 2);
  const double t = step - static_cast<double>(i);
  const auto logOf = [&](double TaperedSize::*value, double TaperedSize::*slope) {
    return hermite(table[i].*value, table[i].*slope / kTapersPerUnit, table[i + 1].*value,
                   table[i + 1].*slope / kTapersPerUnit, t);
  };
  const auto [volume, volume_slope] = logOf(&TaperedSize::log_volume, &TaperedSize::volume_slope);
  const auto [widest, widest_slope] = logOf(&TaperedSize::log_widest, &TaperedSize::widest_slope);
  return {wallOutline().volume() * std::exp(volume), wallOutline().widest() * std::exp(widest),
          kTapersPerUnit * volume_slope, kTapersPerUnit * widest_slope};
}

WallPlace wallPlaceOf(Vec3d direction) {
  const double share = shareOf(direction);
  const Meridian::Point at = wallOutline().at(share);
  // Turned by an odd angle, so that no edge of the mesh lies in an imaging plane.
  constexpr double kTurn_rad = 0.3;
  WallPlace place = placeOf(std::atan2(direction.y, direction.x) + kTurn_rad, at.zeta, at.rho);
  constexpr double kStep = 0.015;  // of the outline
  const Meridian::Point before = wallOutline().at(std::abs(share - kStep));
  const Meridian::Point after = wallOutline().at(1 - std::abs(1 - share - kStep));
  // Beyond either end the outline continues on the other side.
  place.before = {share < kStep ? -before.rho : before.rho, leanOf(before.zeta)};
  place.after = {share > 1 - kStep ? -after.rho : after.rho, leanOf(after.zeta)};
  place.outward = before.zeta - after.zeta;
  return place;
}

WallPlace wallPlaceAt(double phi_rad, double zeta) {
  return placeOf(phi_rad, zeta, wallOutline().rhoAt(zeta));
}

const std::vector<WallPlace>& meshPlaces() {
  static const std::vector<WallPlace> places = [] {
    std::vector<WallPlace> made;
    for (const Vec3d direction : geodesicSphere(kWallFrequency).directions)
      made.push_back(wallPlaceOf(direction));
    return made;
  }();
  return places;
}

}  // namespace echocine::heart
