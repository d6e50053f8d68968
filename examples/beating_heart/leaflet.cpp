#include "examples/beating_heart/leaflet.h"

#include <array>
#include <cmath>

namespace echocine::beating_heart {
namespace {

constexpr int kStepsPerRow = 8;

// The leaflet's slope against the ring's plane at a share v of its length. Closed, it bulges a
// little towards the atrium and turns into the ventricle where it lies against the other leaflet;
// open, it swings down and follows the ventricle's wall.
double slope(double v, double closed_rad, double open_rad, double opening) {
  constexpr double kClosedBend_rad = 1.0, kOpenBend_rad = 0.45;
  const double closed = closed_rad + kClosedBend_rad * v * v;
  const double open = open_rad + kOpenBend_rad * (v - 0.5);
  return (1 - opening) * closed + opening * open;
}

struct Profile {
  std::array<double, kLeafletRows> reach{}, drop{};  // across the ring and into the ventricle
};

// A leaflet of unit length, seen from the side.
Profile profileOf(double closed_rad, double open_rad, double opening) {
  Profile profile;
  const int steps = kStepsPerRow * (kLeafletRows - 1);
  double reach = 0, drop = 0;
  for (int i = 0; i < steps; ++i) {
    const double angle_rad = slope((i + 0.5) / steps, closed_rad, open_rad, opening);
    reach += std::cos(angle_rad) / steps;
    drop += std::sin(angle_rad) / steps;
    if ((i + 1) % kStepsPerRow != 0) continue;
    profile.reach[(i + 1) / kStepsPerRow] = reach;
    profile.drop[(i + 1) / kStepsPerRow] = drop;
  }
  return profile;
}

// The closed slope at the hinge that brings the tip to the given drop over reach.
double closedSlope(double drop_over_reach) {
  double low_rad = -1, high_rad = 1;
  for (int i = 0; i < 50; ++i) {
    const double middle_rad = 0.5 * (low_rad + high_rad);
    const Profile closed = profileOf(middle_rad, 0, 0);
    const bool too_flat = closed.drop.back() < drop_over_reach * closed.reach.back();
    (too_flat ? low_rad : high_rad) = middle_rad;
  }
  return 0.5 * (low_rad + high_rad);
}

}  // namespace

std::vector<Vec3d> leafletPoints(const ValveRing& ring, const Leaflet& leaflet, double opening) {
  // The commissures: where the line of coaptation meets the ring, but for a remainder that keeps
  // the sheet from ending in a point.
  const double half_arc_rad =
      0.96 * std::acos(leaflet.hinge * leaflet.coaptation_cm / ring.radius_cm);
  std::vector<Vec3d> points(kLeafletRows * kLeafletColumns);
  for (int column = 0; column < kLeafletColumns; ++column) {
    // Uneven columns, so that none of them lies in the imaging plane.
    const double u = 2.0 * column / (kLeafletColumns - 1) - 1;
    const double angle_rad = half_arc_rad * (u + 0.06 * (1 - u * u));
    const double hinge_x = leaflet.hinge * ring.radius_cm * std::cos(angle_rad);
    const double hinge_y = ring.radius_cm * std::sin(angle_rad);
    const double inward_x = leaflet.coaptation_cm - hinge_x, inward_y = -0.1 * hinge_y;
    const double reach_cm = std::hypot(inward_x, inward_y);
    const double across =
        std::sin(angle_rad);  // both leaflets' tips follow the same line of coaptation
    const double tent_cm = leaflet.tent_cm * (1 - 0.65 * across * across);
    const double closed_rad = closedSlope(tent_cm / reach_cm);
    const double length_cm = reach_cm / profileOf(closed_rad, 0, 0).reach.back();
    const Profile profile = profileOf(closed_rad, leaflet.open_rad, opening);
    for (int row = 0; row < kLeafletRows; ++row) {
      const double share = length_cm * profile.reach[row] / reach_cm;
      points[row * kLeafletColumns + column] =
          ring.centre_cm + (hinge_x + share * inward_x) * ring.side +
          (hinge_y + share * inward_y) * ring.up + length_cm * profile.drop[row] * ring.inflow;
    }
  }
  return points;
}

}  // namespace echocine::beating_heart
