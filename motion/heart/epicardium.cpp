#include "motion/heart/epicardium.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "motion/heart/four_points.h"
#include "motion/heart/heart_units.h"
#include "motion/heart/smooth.h"

namespace echocine::heart {
namespace {

constexpr int kAngles = 90, kHeights = 120;  // of the table
constexpr int kSamples = 240;                // along a meridian

struct Sample {
  double phi_rad, r, z;
};

// The places over each angle of the mesh, apex to base.
const std::vector<std::vector<WallPlace>>& meridianPlaces() {
  static const std::vector<std::vector<WallPlace>> places = [] {
    std::vector<std::vector<WallPlace>> made(kAngles);
    for (int a = 0; a < kAngles; ++a)
      for (int i = 1; i < kSamples; ++i) {
        const double azimuth_rad = kTurn * a / kAngles, polar_rad = std::numbers::pi * i / kSamples;
        made[a].push_back(
            wallPlaceOf({std::sin(polar_rad) * std::cos(azimuth_rad),
                         std::sin(polar_rad) * std::sin(azimuth_rad), std::cos(polar_rad)}));
      }
    return made;
  }();
  return places;
}

// The wall's points there, down to the first one at or below `low_z`; twist and bow change their
// angle.
std::vector<Sample> meridianOf(const LeftVentricle& ventricle, const std::vector<WallPlace>& places,
                               double low_z) {
  std::vector<Sample> samples;
  samples.reserve(places.size());
  for (const WallPlace& place : places) {
    const Vec3d p = ventricle.wallPoint(place);
    samples.push_back({std::atan2(p.y, p.x), hypotenuse(p.x, p.y), p.z});
    if (samples.size() > 1 && p.z <= low_z) break;
  }
  return samples;
}

// The meridian at a given height: the first place below it, starting at the apex. `i` is the first
// place to test (1 at the apex) and returns the place's index, for descending heights.
Sample atHeight(const std::vector<Sample>& meridian, double z, std::size_t& i) {
  while (i + 1 < meridian.size() && meridian[i].z > z) ++i;
  const Sample &a = meridian[i - 1], &b = meridian[i];
  const double t = a.z > b.z ? std::clamp((a.z - z) / (a.z - b.z), 0.0, 1.0) : 0;
  const double turn = std::remainder(b.phi_rad - a.phi_rad, kTurn);
  return {a.phi_rad + t * turn, std::lerp(a.r, b.r, t), z};
}

}  // namespace

Epicardium::Epicardium(const LeftVentricle& ventricle) {
  // Close to the base the wall turns inwards to the valves and no longer affects its neighbours.
  low_z_ = ventricle.ringZ() + 0.04 * ventricle.length();
  std::vector<std::vector<Sample>> meridians;
  for (const auto& places : meridianPlaces())
    meridians.push_back(meridianOf(ventricle, places, low_z_));
  high_z_ = std::numeric_limits<double>::max();
  for (const auto& meridian : meridians) high_z_ = std::min(high_z_, meridian.front().z);
  radius_m_.resize(std::size_t{kAngles} * kHeights);
  std::vector<std::size_t> reached(meridians.size(), 1);
  for (int h = kHeights - 1; h >= 0; --h) {
    const double z = std::lerp(low_z_, high_z_, double(h) / (kHeights - 1));
    std::vector<Sample> ring;
    for (std::size_t m = 0; m < meridians.size(); ++m)
      ring.push_back(atHeight(meridians[m], z, reached[m]));
    for (Sample& sample : ring) sample.phi_rad -= kTurn * std::floor(sample.phi_rad / kTurn);
    std::sort(ring.begin(), ring.end(),
              [](const Sample& a, const Sample& b) { return a.phi_rad < b.phi_rad; });
    for (int a = 0; a < kAngles; ++a) {
      const double phi_rad = kTurn * a / kAngles;
      const auto above = std::upper_bound(
          ring.begin(), ring.end(), phi_rad,
          [](double value, const Sample& sample) { return value < sample.phi_rad; });
      const Sample& right = above == ring.end() ? ring.front() : *above;
      const Sample& left = above == ring.begin() ? ring.back() : *(above - 1);
      const double gap = right.phi_rad - left.phi_rad;
      const double span = gap - kTurn * std::floor(gap / kTurn);
      const double rise = phi_rad - left.phi_rad;
      const double t = span > 0 ? (rise - kTurn * std::floor(rise / kTurn)) / span : 0;
      radius_m_[std::size_t(a) * kHeights + h] = std::lerp(left.r, right.r, t);
    }
  }
}

Doubles4 Epicardium::radius(Doubles4 phi_rad, Doubles4 z) const {
  const Doubles4 height =
      clamped((z - low_z_) / (high_z_ - low_z_), Doubles4{}, Doubles4{} + 1) * (kHeights - 1);
  const Doubles4 turns = phi_rad / kTurn, angle = (turns - floorOf(turns)) * kAngles;
  Doubles4 below, low_a, high_a, low_b, high_b;
  for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
    const int h = std::min(static_cast<int>(height[lane]), kHeights - 2);
    const int a = static_cast<int>(angle[lane]) % kAngles, b = (a + 1) % kAngles;
    const double* const at_a = &radius_m_[std::size_t(a) * kHeights + h];
    const double* const at_b = &radius_m_[std::size_t(b) * kHeights + h];
    below[lane] = h;
    low_a[lane] = at_a[0], high_a[lane] = at_a[1];
    low_b[lane] = at_b[0], high_b[lane] = at_b[1];
  }
  const Doubles4 up = height - below;
  return blended(blended(low_a, high_a, up), blended(low_b, high_b, up), angle - floorOf(angle));
}

void Epicardium::pushOut(double gap_m, std::vector<Vec3d>& points) const {
  constexpr double kRounding_m = 4e-3;
  for (std::size_t i = 0; i < points.size(); i += kDoubleLanes) {
    const FourPoints p = fourPointsAt(points, i);
    const Mask4 above = p.z > high_z_ + gap_m;
    const Doubles4 r = hypotenuse(p.x, p.y);
    Doubles4 phi_rad{};
    for (std::size_t lane = 0; lane < kDoubleLanes; ++lane)
      if (!above[lane]) phi_rad[lane] = std::atan2(p.y[lane], p.x[lane]);
    const Doubles4 limit = radius(phi_rad, p.z) + gap_m;
    const Doubles4 grow = smoothMax(r, limit, kRounding_m) / larger(r, 1e-6);
    put(where(above, p, {grow * p.x, grow * p.y, p.z}), points, i);
  }
}

}  // namespace echocine::heart
