#include "motion/heart/heart.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/stop.h"
#include "motion/heart/envelope.h"
#include "motion/heart/heart_units.h"
#include "motion/heart/instant.h"
#include "motion/heart/segment_shares.h"

namespace echocine::heart {
namespace {

// Cavities cut holes into walls. If two walls or cavities touch, the left heart's or the rounder
// one keeps its shape, so the septum belongs to the left ventricle and the right heart wraps around
// it.
void addChambers(const Instant& now, std::vector<Part>& parts) {
  static const SphereMesh &kVentricle = geodesicSphere(LeftVentricle::kFrequency),
                          &kAtrium = geodesicSphere(Instant::kAtriumFrequency),
                          &kVessel = geodesicSphere(7), &kMuscle = geodesicSphere(4);
  const auto addPoints = [&](const char* name, const char* medium, int priority,
                             const SphereMesh& sphere, std::vector<Vec3d> points) {
    parts.push_back({{name, medium, priority, false}, std::move(points), sphere.faces});
  };
  const auto add = [&](const char* name, const char* medium, int priority, const SphereMesh& sphere,
                       auto&& pointOf) {
    addPoints(name, medium, priority, sphere, pointsOn(sphere, pointOf));
  };
  const WallThickness& wall = now.walls();
  addPoints("papillary_anterolateral", "myocardium", 95, kMuscle, now.papillary(0, kMuscle));
  addPoints("papillary_posteromedial", "myocardium", 95, kMuscle, now.papillary(1, kMuscle));
  addPoints("lv_cavity", "blood", 90, kVentricle, now.left().cavityPoints());
  add("aorta", "blood", 85, kVessel, [&](Vec3d d) { return now.aorta().point(d); });
  addPoints("la", "blood", 80, kAtrium, now.leftAtrium());
  addPoints("lv_wall", "myocardium", 70, kVentricle, now.left().wallPoints());
  add("aortic_wall", "vessel_wall", 65, kVessel,
      [&](Vec3d d) { return now.aorta().point(d, wall.vessel_m); });
  addPoints("la_wall", "myocardium", 60, kAtrium, now.leftAtrium(wall.atrium_m));
  add("rv_cavity", "blood", 50, kVentricle, [&](Vec3d d) { return now.right().cavityPoint(d); });
  addPoints("ra", "blood", 45, kAtrium, now.rightAtrium());
  add("pulmonary_artery", "blood", 40, kVessel,
      [&](Vec3d d) { return now.pulmonaryArtery().point(d); });
  add("pulmonary_wall", "vessel_wall", 35, kVessel,
      [&](Vec3d d) { return now.pulmonaryArtery().point(d, wall.vessel_m); });
  add("rv_wall", "myocardium", 30, kVentricle,
      [&](Vec3d d) { return now.right().wallPoint(d, wall.rv_m); });
  addPoints("ra_wall", "myocardium", 25, kAtrium, now.rightAtrium(wall.atrium_m));
}

// Epicardial fat fills the grooves between the walls; the sac encloses everything.
void addSac(Vec3d centre, double scale, std::vector<Part>& parts) {
  constexpr double kSac_m = 1.5e-3, kLoose_m = 0.8e-3;  // our choice
  std::vector<Vec3d> outside;
  for (const Part& part : parts)
    for (const std::string_view name : {"lv_wall", "rv_wall", "la_wall", "ra_wall"})
      if (part.kind.name == name)
        outside.insert(outside.end(), part.points.begin(), part.points.end());
  const Envelope envelope(outside, centre);
  const auto add = [&](const char* name, const char* medium, int priority, double gap_m) {
    checkpoint();
    parts.push_back({{name, medium, priority, false},
                     envelope.points(gap_m * scale),
                     geodesicSphere(Envelope::kFrequency).faces});
  };
  add("grooves", "epicardial_fat", 22, kLoose_m);
  add("pericardium", "pericardium", 20, kLoose_m + kSac_m);
}

// Angles about the mitral ring are like phi: the anterior leaflet is beside the aorta.
void addLeaflets(const Instant& now, std::vector<Part>& parts) {
  const auto add = [&](const char* name, std::vector<Vec3d> points) {
    parts.push_back(
        {{name, "valve", 0, true}, std::move(points), sheetFaces(kLeafletRows, kLeafletColumns)});
  };
  const State& state = now.state();
  const double mitral_m = now.mitral().radius_m, tricuspid_m = now.tricuspid().radius_m;
  constexpr LeafletMotion kAnterior{76 * kDegree, 1.0, 0.45}, kPosterior{80 * kDegree, 1.0, 0.3};
  add("mitral_anterior", pairedLeaflet(now.mitral(), 130 * kDegree, -0.20 * mitral_m,
                                       0.30 * mitral_m, kAnterior, state.mitral));
  add("mitral_posterior", pairedLeaflet(now.mitral(), 310 * kDegree, 0.26 * mitral_m,
                                        0.30 * mitral_m, kPosterior, state.mitral));
  // The septal leaflet opens least, because the septum leans over it.
  constexpr LeafletMotion kSeptal{50 * kDegree, 1.0, 0.45}, kLateral{78 * kDegree, 1.0, 0.45};
  add("tricuspid_septal", pairedLeaflet(now.tricuspid(), 0, 0.22 * tricuspid_m, 0.28 * tricuspid_m,
                                        kSeptal, state.tricuspid));
  add("tricuspid_anterior", pairedLeaflet(now.tricuspid(), 180 * kDegree, -0.16 * tricuspid_m,
                                          0.28 * tricuspid_m, kLateral, state.tricuspid));
  constexpr LeafletMotion kCusp{84 * kDegree, 1.9, 0.15};
  const auto cusps = [&](const ValveRing& ring, std::array<const char*, 3> names, double first_rad,
                         double opening) {
    for (int i = 0; i < 3; ++i)
      add(names[i],
          starCusp(ring, first_rad + i * 120 * kDegree, 0.30 * ring.radius_m, kCusp, opening));
  };
  cusps(now.aortic(), {"aortic_left", "aortic_right", "aortic_non_coronary"}, 30 * kDegree,
        state.aortic);
  cusps(now.pulmonary(), {"pulmonary_left", "pulmonary_anterior", "pulmonary_right"}, 0,
        state.pulmonary);
}

}  // namespace

namespace {

// Akinetic segments reduce the ejection. A ventricle that ejects next to nothing is rejected:
// circulation would have stopped.
Parameters withSegmentsRuling(Parameters parameters) {
  const bool healthy = std::all_of(parameters.segments.begin(), parameters.segments.end(),
                                   [](const Segment& segment) { return segment.amplitude == 1; });
  if (parameters.volumes_rule || healthy) return parameters;
  constexpr double kLeast = 0.03;
  const double left = LeftVentricle::ejectionFractionOf(parameters);
  if (!(left >= kLeast))
    throw SceneError(
        fmt::format("segment: with these values the left ventricle ejects {:.3f} of its "
                    "volume, accepted: {} or more",
                    left, kLeast));
  parameters.ejection_fraction = left;
  return parameters;
}

std::vector<Part> partsOf(const Instant& now, const ParametricHeart& heart) {
  std::vector<Part> parts;
  addChambers(now, parts);
  addSac(heart.centre(), heart.parameters().body_scale, parts);
  addLeaflets(now, parts);
  return parts;
}

Landmarks landmarksOf(const Instant& now) {
  Landmarks marks;
  marks.apex = {0, 0, now.left().apexZ()};
  marks.mitral = now.mitral().centre;
  marks.tricuspid = now.tricuspid().centre;
  marks.tricuspid_lateral =
      now.tricuspid().centre - now.tricuspid().radius_m * now.tricuspid().side;
  marks.aortic = now.aortic().centre;
  marks.pulmonary = now.pulmonary().centre;
  marks.aortic_flow = now.aortic().flow;
  marks.mitral_radius_m = now.mitral().radius_m;
  marks.tricuspid_radius_m = now.tricuspid().radius_m;
  marks.twist_rad = now.left().twist();
  for (int s = 0; s < kSegments; ++s) {
    const SegmentPlace place = segmentCentre(s);
    marks.wall_thickness_m[s] = now.left().wallThicknessAt(place.phi_rad, place.zeta);
  }
  return marks;
}

}  // namespace

ParametricHeart::ParametricHeart(const Parameters& parameters)
    : parameters_(withSegmentsRuling(parameters)), cycle_(parameters_), at_rest_(parameters_) {}

Vec3d ParametricHeart::centre() const {
  return lvLength() * Vec3d{-0.25, 0.1, 0.25};
}

std::vector<Part> ParametricHeart::at(double phase) const {
  return partsOf(Instant(parameters_, at_rest_, cycle_.at(phase)), *this);
}

Landmarks ParametricHeart::landmarksAt(double phase) const {
  return landmarksOf(Instant(parameters_, at_rest_, cycle_.at(phase)));
}

Shape ParametricHeart::shapeAt(double phase) const {
  const Instant now(parameters_, at_rest_, cycle_.at(phase));
  return {partsOf(now, *this), landmarksOf(now)};
}

}  // namespace echocine::heart
