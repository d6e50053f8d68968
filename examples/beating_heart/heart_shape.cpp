#include "examples/beating_heart/heart_shape.h"

#include <cmath>
#include <functional>
#include <numbers>

#include "examples/beating_heart/chamber.h"
#include "examples/beating_heart/heart_cycle.h"
#include "examples/beating_heart/leaflet.h"

namespace echocine::beating_heart {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct WallThickness {
  double apex_cm, side_cm, ring_cm, beyond_ring_cm;
};

Chamber thickened(Chamber chamber, const WallThickness& wall) {
  const Vec3d axis = normalised(chamber.ring_cm - chamber.apex_cm);
  chamber.apex_cm = chamber.apex_cm - wall.apex_cm * axis;
  chamber.radius_cm += wall.side_cm;
  chamber.ring_radius_cm += wall.ring_cm;
  chamber.beyond_ring_cm += wall.beyond_ring_cm;
  return chamber;
}

// A neighbour that a surface gives way to, and how deep it may still reach under it.
struct Neighbour {
  ChamberSurface surface;
  double depth_cm;
};
using Neighbours = std::vector<Neighbour>;

std::vector<Vec3d> pointsBeside(const Chamber& chamber, const Neighbours& neighbours,
                                const SphereMesh& sphere) {
  std::vector<Vec3d> points = pointsOf(ChamberSurface(chamber), sphere);
  for (Vec3d& point : points)
    for (const Neighbour& neighbour : neighbours)
      point = neighbour.surface.pushedOut(point, neighbour.depth_cm);
  return points;
}

// The x in [low, high] at which a growing function reaches `wanted`.
double solve(double low, double high, double wanted, const std::function<double(double)>& f) {
  for (int i = 0; i < 44; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double volumeBeside(const Chamber& chamber, const Neighbours& neighbours) {
  static const SphereMesh kFine = geodesicSphere(12);  // 0.5 % below the smooth surface's volume
  constexpr double kFacetLoss = 1.005;
  return kFacetLoss * volumeOf(pointsBeside(chamber, neighbours, kFine), kFine.faces);
}

Chamber withVolume(Chamber chamber, const Neighbours& neighbours, double volume_ml) {
  const auto grow = [&](double radius_cm) {
    chamber.radius_cm = radius_cm;
    return volumeBeside(chamber, neighbours);
  };
  grow(solve(0.5, 5, volume_ml, grow));
  return chamber;
}

constexpr double kMitralExcursion_cm = 1.3, kTricuspidExcursion_cm = 1.7;

Chamber leftVentricle(const HeartState& state) {
  Chamber lv;
  lv.apex_cm = {0.55, 0, -8.5 + 0.1 * state.contraction};
  const Vec3d ring_at_rest_cm{1.95, 0, 0};
  const Vec3d axis = normalised(ring_at_rest_cm - lv.apex_cm);
  lv.ring_cm = ring_at_rest_cm - kMitralExcursion_cm * state.contraction * axis;
  lv.beyond_ring_cm = 0.3;
  lv.widest = 0.58;
  lv.ring_radius_cm = 1.72 - 0.30 * state.contraction;
  lv.bow_cm = 0.40 - 0.22 * state.contraction;
  lv.apex_exponent = 2.1;
  lv.cap_exponent = 4;
  lv.twist_rad = 9 * kDegree * state.contraction;
  return withVolume(lv, {}, state.lv_volume_ml);
}

// The left ventricle's outer surface. Muscle does not change its volume: as the cavity shrinks it
// thickens.
Chamber leftWall(const Chamber& lv, double muscle_ml) {
  const auto outer = [&](double side_cm) {
    return thickened(lv, {0.55 + 0.25 * side_cm, side_cm, 0.25 + 0.5 * side_cm, 0.15});
  };
  const double total_ml = volumeBeside(lv, {}) + muscle_ml;
  return outer(
      solve(0.3, 3, total_ml, [&](double side_cm) { return volumeBeside(outer(side_cm), {}); }));
}

Chamber rightVentricle(const HeartState& state, const Neighbours& beside) {
  Chamber rv;
  rv.apex_cm = {-1.6, 0, -7.4 + 0.2 * state.contraction};
  // The ring keeps to the septum, which thickens towards it.
  const Vec3d ring_at_rest_cm{-2.46 - 0.20 * state.contraction, 0, -0.3};
  const Vec3d axis = normalised(ring_at_rest_cm - rv.apex_cm);
  rv.ring_cm = ring_at_rest_cm - kTricuspidExcursion_cm * state.contraction * axis;
  rv.beyond_ring_cm = 0.3;
  rv.widest = 0.78;
  rv.ring_radius_cm = 1.62 - 0.2 * state.contraction;
  rv.aspect = 1.75;
  rv.wrap_per_cm = 0.08;
  rv.apex_exponent = 1.6;
  rv.cap_exponent = 4;
  return withVolume(rv, beside, state.rv_volume_ml);
}

// An atrium below a ventricle whose valve ring it shares. Its septal side stays where it is: the
// axis bows towards the septum by what the radius lacks of `septal_cm`, positive to the left in the
// image.
Chamber atrium(const Chamber& ventricle, Vec3d roof_cm, double septal_cm, double volume_ml,
               const Neighbours& beside) {
  Chamber atrium;
  atrium.apex_cm = roof_cm;
  atrium.ring_cm = ventricle.ring_cm;
  atrium.beyond_ring_cm = 0.4;
  atrium.widest = 0.5;
  atrium.ring_radius_cm = ventricle.ring_radius_cm - 0.05;
  atrium.apex_exponent = 2.3;
  atrium.cap_exponent = 3;
  const auto grow = [&](double radius_cm) {
    atrium.radius_cm = radius_cm;
    atrium.bow_cm = septal_cm - std::copysign(radius_cm, septal_cm);
    return volumeBeside(atrium, beside);
  };
  grow(solve(0.5, 4, volume_ml, grow));
  return atrium;
}

ValveRing ringOf(const Chamber& ventricle) {
  ValveRing ring;
  ring.centre_cm = ventricle.ring_cm;
  ring.inflow = normalised(ventricle.apex_cm - ventricle.ring_cm);
  ring.up = {0, 1, 0};
  ring.side = cross(ring.inflow, ring.up);
  if (ring.side.x < 0) ring.side = -ring.side;
  ring.radius_cm = ventricle.ring_radius_cm + 0.13;  // hinged within the wall
  return ring;
}

struct Chambers {
  Chamber lv, lv_wall, rv, rv_wall, la, la_wall, ra, ra_wall;
  Neighbours beside_lv, beside_la;  // what the right heart gives way to
};

Chambers chambersOf(const HeartState& state) {
  constexpr double kLeftMuscle_ml = 135;
  constexpr WallThickness kAtrialWall{0.25, 0.25, 0.25, 0.1};
  Chambers heart;
  heart.lv = leftVentricle(state);
  heart.lv_wall = leftWall(heart.lv, kLeftMuscle_ml);
  heart.beside_lv = {{ChamberSurface(heart.lv_wall), 0.15}};
  heart.rv = rightVentricle(state, heart.beside_lv);
  const double rv_wall_cm = 0.38 + 0.12 * state.contraction;
  heart.rv_wall = thickened(heart.rv, {rv_wall_cm, rv_wall_cm, rv_wall_cm, 0.05});

  const double descent_cm = 0.5 * state.contraction;  // of the roofs, as the atria fill
  heart.la = atrium(heart.lv, {1.95, 0, 3.6 + descent_cm}, 1.95, state.la_volume_ml, {});
  heart.la_wall = thickened(heart.la, kAtrialWall);
  heart.beside_la = {{ChamberSurface(heart.la_wall), 0.1}};
  heart.ra =
      atrium(heart.rv, {-2.4, 0, 3.3 + descent_cm}, -2.35, state.ra_volume_ml, heart.beside_la);
  heart.ra_wall = thickened(heart.ra, kAtrialWall);
  return heart;
}

// Each leaflet: hinge side, coaptation and tent in cm, open angle. The septal leaflet of the
// tricuspid valve opens least, for the septum leans over it.
void addLeaflets(const Chambers& heart, const HeartState& state, std::vector<Part>& parts) {
  const auto add = [&](const char* name, const Chamber& ventricle, const Leaflet& leaflet,
                       double opening) {
    parts.push_back({name, leafletPoints(ringOf(ventricle), leaflet, opening),
                     sheetFaces(kLeafletRows, kLeafletColumns)});
  };
  const double mitral = state.mitral_opening, tricuspid = state.tricuspid_opening;
  add("mitral_anterior", heart.lv, {-1, 0.38, 0.62, 78 * kDegree}, mitral);
  add("mitral_posterior", heart.lv, {1, 0.42, 0.62, 78 * kDegree}, mitral);
  add("tricuspid_septal", heart.rv, {1, 0.37, 0.6, 45 * kDegree}, tricuspid);
  add("tricuspid_lateral", heart.rv, {-1, 0.33, 0.6, 80 * kDegree}, tricuspid);
}

}  // namespace

std::vector<Part> heartAt(double phase) {
  static const SphereMesh kVentricle = geodesicSphere(7), kAtrium = geodesicSphere(5);
  const HeartState state = heartStateAt(phase);
  const Chambers heart = chambersOf(state);
  std::vector<Part> parts;
  const auto add = [&](const char* name, const Chamber& chamber, const Neighbours& neighbours,
                       const SphereMesh& sphere) {
    parts.push_back({name, pointsBeside(chamber, neighbours, sphere), sphere.faces});
  };
  add("lv_cavity", heart.lv, {}, kVentricle);
  add("lv_wall", heart.lv_wall, {}, kVentricle);
  add("rv_cavity", heart.rv, heart.beside_lv, kVentricle);
  add("rv_wall", heart.rv_wall, {}, kVentricle);
  add("la", heart.la, {}, kAtrium);
  add("la_wall", heart.la_wall, {}, kAtrium);
  add("ra", heart.ra, heart.beside_la, kAtrium);
  add("ra_wall", heart.ra_wall, {}, kAtrium);
  addLeaflets(heart, state, parts);
  return parts;
}

}  // namespace echocine::beating_heart
