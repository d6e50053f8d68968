#include "motion/heart/leaflet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace echocine::heart {
namespace {

constexpr int kStepsPerRow = 8;

// Slope of the leaflet at a fraction v of its length.
double slope(double v, double closed_rad, const LeafletMotion& motion, double opening) {
  const double closed = closed_rad + motion.closed_bend_rad * v * v;
  const double open = motion.open_rad + motion.open_bend_rad * (v - 0.5);
  return (1 - opening) * closed + opening * open;
}

struct Profile {
  std::array<double, kLeafletRows> reach{}, drop{};  // across the ring and downstream
};

// A leaflet of unit length, seen from the side.
Profile profileOf(double closed_rad, const LeafletMotion& motion, double opening) {
  Profile profile;
  constexpr int kSteps = kStepsPerRow * (kLeafletRows - 1);
  double reach = 0, drop = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double angle_rad = slope((i + 0.5) / kSteps, closed_rad, motion, opening);
    reach += std::cos(angle_rad) / kSteps;
    drop += std::sin(angle_rad) / kSteps;
    if ((i + 1) % kStepsPerRow != 0) continue;
    profile.reach[(i + 1) / kStepsPerRow] = reach;
    profile.drop[(i + 1) / kStepsPerRow] = drop;
  }
  return profile;
}

// The slope at the hinge of the closed leaflet for a given drop over reach. A steeper hinge rotates
// the closed leaflet as a whole.
double closedSlope(double drop_over_reach, const LeafletMotion& motion) {
  const Profile level = profileOf(0, motion, 0);
  const double bent_rad = std::atan2(level.drop.back(), level.reach.back());
  return std::clamp(std::atan(drop_over_reach) - bent_rad, -1.5, 1.2);
}

// The closed leaflet's hinge and edge in the ring's plane, and how far downstream the edge is.
struct Column {
  double hinge_x, hinge_y, inward_x, inward_y, drop_m;
};

void hang(const ValveRing& ring, const Column& column, int index, const LeafletMotion& motion,
          double opening, std::vector<Vec3d>& points) {
  const double reach_m = std::hypot(column.inward_x, column.inward_y);
  const double closed_rad = closedSlope(column.drop_m / reach_m, motion);
  const double length_m = reach_m / profileOf(closed_rad, motion, 0).reach.back();
  const Profile profile = profileOf(closed_rad, motion, opening);
  for (int row = 0; row < kLeafletRows; ++row) {
    const double share = length_m * profile.reach[row] / reach_m;
    points[row * kLeafletColumns + index] = ring.centre +
                                            (column.hinge_x + share * column.inward_x) * ring.side +
                                            (column.hinge_y + share * column.inward_y) * ring.up +
                                            length_m * profile.drop[row] * ring.flow;
  }
}

// From -1 to 1 over the columns, uneven, so that none of them lies in an imaging plane.
double across(int column) {
  const double u = 2.0 * column / (kLeafletColumns - 1) - 1;
  return u + 0.06 * (1 - u * u);
}

// Commissures keep this fraction of the arc, so that the sheet does not end in a point.
constexpr double kArcKept = 0.92;

}  // namespace

std::vector<Vec3d> pairedLeaflet(const ValveRing& ring, double angle_rad, double coaptation_m,
                                 double tent_m, const LeafletMotion& motion, double opening) {
  ValveRing turned = ring;
  turned.side = std::cos(angle_rad) * ring.side + std::sin(angle_rad) * ring.up;
  turned.up = std::cos(angle_rad) * ring.up - std::sin(angle_rad) * ring.side;
  const double half_arc_rad = kArcKept * std::acos(coaptation_m / ring.radius_m);
  std::vector<Vec3d> points(kLeafletRows * kLeafletColumns);
  for (int column = 0; column < kLeafletColumns; ++column) {
    const double at_rad = half_arc_rad * across(column);
    const double x = ring.radius_m * std::cos(at_rad), y = ring.radius_m * std::sin(at_rad);
    const double sideways = std::sin(at_rad);  // both edges follow one line of coaptation
    hang(turned, {x, y, coaptation_m - x, -0.1 * y, tent_m * (1 - 0.65 * sideways * sideways)},
         column, motion, opening, points);
  }
  return points;
}

std::vector<Vec3d> starCusp(const ValveRing& ring, double angle_rad, double height_m,
                            const LeafletMotion& motion, double opening) {
  constexpr double kHalfArc_rad = kArcKept * std::numbers::pi / 3;
  std::vector<Vec3d> points(kLeafletRows * kLeafletColumns);
  for (int column = 0; column < kLeafletColumns; ++column) {
    const double u = across(column);
    const double at_rad = angle_rad + kHalfArc_rad * u;
    // The edge runs from one commissure to the centre and out to the other.
    const double edge_rad = angle_rad + std::copysign(kHalfArc_rad, u);
    const double out = 0.90 * ring.radius_m * std::abs(u);
    const double x = ring.radius_m * std::cos(at_rad), y = ring.radius_m * std::sin(at_rad);
    const Column hung{x, y, out * std::cos(edge_rad) - x, out * std::sin(edge_rad) - y,
                      height_m * (1 + 0.5 * u * u)};
    hang(ring, hung, column, motion, opening, points);
  }
  return points;
}

}  // namespace echocine::heart
