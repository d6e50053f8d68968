#include "motion/views/heart_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/units.h"
#include "motion/views/contact.h"
#include "motion/views/long_axis.h"
#include "motion/views/role_surfaces.h"
#include "scene/names.h"

namespace echocine {

namespace {

// Shares of the long axis: surfaces closer than the first touch; vertices closer than the second
// belong to the contact.
constexpr double kTouching = 0.12, kContact = 0.04;
// A wall whose middle is so far off the long axis, in its lengths, holds the right ventricle too.
constexpr double kOffAxis = 0.10;
// A ring is flat that is so much thinner than wide; looked at so far below, in long axes. Our
// choice.
constexpr double kFlat = 0.35, kBelowRing = 0.06;
// Where a heart has what, in lengths of the long axis from the mitral ring and as angles about it:
// means over three or four hearts, README.md.
constexpr Vec3d kAorticValve{-0.15, 0.26, 0.02}, kAorticFlow{-0.44, 0.46, -0.77};
constexpr double kRightHeart_deg = 180, kRightVentricle_deg = 157, kAorticValve_deg = 120,
                 kAorta_deg = 126, kPulmonaryValve_deg = 104, kPulmonaryArtery_deg = 97;
// Length of the parametric heart's long axis, at which the body's scale is 1.
constexpr double kAdultLength_m = 0.0875;
// Missing muscle, of the long axis: 9 mm of an adult's 90 mm (normal: 6 to 10 mm, Lang et al., J.
// Am. Soc. Echocardiogr. 28, 1-39, 2015).
constexpr double kWall = 0.10;

// A structure at a known angle about the long axis.
struct Cue {
  Vec3d place;
  double angle_deg;
  std::string name;
};

class Finder {
 public:
  Finder(const std::vector<RoleSurface>& surfaces, const SourcePlace& place)
      : surfaces_(surfaces), place_(place) {}

  HeartMarks find() {
    ventricle();
    findAxis();
    refuseMixedSides();
    findSides();
    findAorta();
    marks_.outside_m = outsideOf(surfaces_);
    for (const Role role : {Role::la, Role::la_wall, Role::pericardium})
      marks_.frame.has_left_atrium |= !facets(role).empty();
    marks_.front_m = frontOf(surfaces_);
    if (!hasWall(surfaces_)) marks_.wall_m = kWall * marks_.frame.length_m;
    return marks_;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw SceneError(atPlace(place_, what)); }

  Facets facets(Role role) const { return facetsOf(surfaces_, role); }
  std::optional<Vec3d> middle(Role role) const {
    const Facets all = meshedFacetsOf(surfaces_, role);
    return all.empty() ? std::nullopt : std::optional(middleOf(all));
  }
  std::string nameOfRole(Role role) const { return namedRole(surfaces_, role); }

  void ventricle();
  Vec3d towardsBase() const;
  void findAxis();
  void refuseMixedSides() const;
  std::optional<Cue> rightCue() const;
  std::optional<Cue> anteriorCue() const;
  std::optional<Cue> wallCue() const;
  Vec3d across(Vec3d place) const;
  void findSides();
  void findAorta();
  void lookFromBelow();

  const std::vector<RoleSurface>& surfaces_;
  const SourcePlace& place_;
  Facets cavity_;
  HeartMarks marks_;
};

void Finder::ventricle() {
  cavity_ = facets(Role::lv_cavity);
  if (cavity_.empty()) cavity_ = facets(Role::lv_wall);
  if (cavity_.size() < 4)
    fail(
        fmt::format("is found from structures with roles; {}; accepted: role = \"lv_cavity\" (or "
                    "\"lv_wall\") of one structure, better with rv_cavity and mitral_valve or la",
                    rolesThere(surfaces_)));
}

// By what lies beyond the base of a left ventricle.
Vec3d Finder::towardsBase() const {
  const Vec3d from = middleOf(cavity_);
  const Vec3d axis = principalAxis(cavity_);
  double extent = 0;
  for (const Facet& f : cavity_)
    for (const Vec3d p : f) extent = std::max(extent, 2 * std::abs(dot(p - from, axis)));
  Vec3d first{};
  Role first_role = Role::none;
  for (const Role role : {Role::mitral_valve, Role::la, Role::la_wall, Role::aortic_valve,
                          Role::aorta, Role::aortic_wall, Role::tricuspid_valve, Role::ra,
                          Role::pulmonary_valve, Role::pulmonary_artery}) {
    const auto there = middle(role);
    if (!there || std::abs(dot(*there - from, axis)) < 0.25 * extent) continue;
    if (first_role == Role::none) {
      first = *there - from;
      first_role = role;
    } else if (dot(first, axis) * dot(*there - from, axis) < 0) {
      fail(fmt::format(
          "{} and {} lie beyond opposite ends of the left ventricle, in a heart both lie "
          "at its base: correct their roles or positions",
          nameOfRole(first_role), nameOfRole(role)));
    }
  }
  return first;
}

void Finder::findAxis() {
  VentricleAxis axis = axisOfCavity(cavity_, towardsBase());
  const double margin = kContact * axis.length();
  bool ring_known = true;
  if (const auto valve = middle(Role::mitral_valve)) {
    axis = axisFromBase(cavity_, *valve);
  } else if (const Facets atrium = facets(Role::la); atrium.empty()) {
    ring_known = false;
  } else {
    const Contact ring = contactOf(cavity_, atrium, margin);
    if (ring.gap < kTouching * axis.length()) axis = axisFromBase(cavity_, ring.middle);
    ring_known = ring.gap < kTouching * axis.length();
  }
  if (!ring_known)
    marks_.told.push_back(
        "no structure has the role of the mitral valve: the long axis is that of the "
        "cavity's shape, some 10 deg off in a heart; give a structure role = "
        "\"mitral_valve\", or \"la\" where the atrium touches the ventricle");
  HeartFrame& f = marks_.frame;
  f.origin = f.mitral = axis.base;
  f.apex = axis.apex;
  f.apical = axis.direction();
  f.length_m = axis.length();
  f.scale = f.length_m / kAdultLength_m;
}

// Left and right changed about, or roles of two hearts.
void Finder::refuseMixedSides() const {
  const auto rv = middle(Role::rv_cavity), la = middle(Role::la), ra = middle(Role::ra);
  const Vec3d lv = middleOf(cavity_);
  if (rv && la && ra && dot(*la - *ra, lv - *rv) < 0)
    fail(
        fmt::format("{} lies on the side of {}, and {} on that of the left ventricle: correct the "
                    "roles, left and right are mixed up",
                    nameOfRole(Role::la), nameOfRole(Role::rv_cavity), nameOfRole(Role::ra)));
  for (const Role role :
       {Role::mitral_valve, Role::aortic_valve, Role::rv_cavity, Role::la, Role::ra})
    if (const auto there = middle(role); there && length(*there - lv) > 3 * marks_.frame.length_m)
      fail(
          fmt::format("{} lies {:.0f} mm from the left ventricle, which is {:.0f} mm long: correct "
                      "its role or position",
                      nameOfRole(role), millimetresFromMetres(length(*there - lv)),
                      millimetresFromMetres(marks_.frame.length_m)));
}

// The right heart, by its most reliable structure.
std::optional<Cue> Finder::rightCue() const {
  if (const auto valve = middle(Role::tricuspid_valve))
    return Cue{*valve, kRightHeart_deg, nameOfRole(Role::tricuspid_valve)};
  const Facets rv = facets(Role::rv_cavity), ra = facets(Role::ra);
  if (!rv.empty() && !ra.empty()) {
    const Contact ring = contactOf(rv, ra, kContact * marks_.frame.length_m);
    if (ring.gap < kTouching * marks_.frame.length_m)
      return Cue{ring.middle, kRightHeart_deg, nameOfRole(Role::ra)};
  }
  if (!ra.empty()) return Cue{middleOf(ra), kRightHeart_deg, nameOfRole(Role::ra)};
  if (!rv.empty()) return Cue{middleOf(rv), kRightVentricle_deg, nameOfRole(Role::rv_cavity)};
  if (const auto wall = middle(Role::rv_wall))
    return Cue{*wall, kRightVentricle_deg, nameOfRole(Role::rv_wall)};
  return std::nullopt;
}

// The structure in front of a left ventricle.
std::optional<Cue> Finder::anteriorCue() const {
  const std::pair<Role, double> known[] = {{Role::aortic_valve, kAorticValve_deg},
                                           {Role::aorta, kAorta_deg},
                                           {Role::aortic_wall, kAorta_deg},
                                           {Role::pulmonary_valve, kPulmonaryValve_deg},
                                           {Role::pulmonary_artery, kPulmonaryArtery_deg}};
  for (const auto& entry : known)
    if (const auto there = middle(entry.first))
      return Cue{*there, entry.second, nameOfRole(entry.first)};
  return std::nullopt;
}

// A wall around both ventricles.
std::optional<Cue> Finder::wallCue() const {
  for (const Role role : {Role::lv_wall, Role::epicardium, Role::pericardium})
    if (const auto there = middle(role);
        there && length(across(*there)) > kOffAxis * marks_.frame.length_m)
      return Cue{*there, kRightVentricle_deg, nameOfRole(role)};
  return std::nullopt;
}

Vec3d Finder::across(Vec3d place) const {
  const HeartFrame& f = marks_.frame;
  return (place - f.origin) - dot(place - f.origin, f.apical) * f.apical;
}

void Finder::findSides() {
  HeartFrame& f = marks_.frame;
  const auto right = rightCue(), front = anteriorCue();
  auto cue = right ? right : front;
  if (!cue) cue = wallCue();
  const bool known = cue && length(across(cue->place)) > 0.02 * f.length_m;
  const Vec3d there = known ? normalised(across(cue->place)) : principalAxis(cavity_, f.apical);
  if (!known)
    marks_.told.push_back(
        "no role identifies the side of the right heart: the view is rotated by the cavity's shape "
        "only; set probe.rotate_deg, or "
        "give a structure role = \"rv_cavity\"");
  // Seen from the base the front of a heart lies clockwise of its right side.
  double hand = 1;
  if (right && front) {
    const Vec3d ahead = across(front->place), aside = across(right->place);
    const double sine = dot(f.apical, cross(ahead, aside)) / (length(ahead) * length(aside));
    if (sine < -std::sin(radiansFromDegrees(10))) hand = -1;
  }
  if (hand < 0)
    marks_.told.push_back(
        fmt::format("{} and {} are arranged as in a mirrored heart, so the view is mirrored too: "
                    "check the axes of the meshes",
                    front->name, right->name));
  const double back_rad = -radiansFromDegrees(known ? cue->angle_deg : kRightHeart_deg);
  f.lateral = std::cos(back_rad) * there + hand * std::sin(back_rad) * cross(f.apical, there);
  f.lateral = normalised(f.lateral - dot(f.lateral, f.apical) * f.apical);
  f.anterior = hand * cross(f.apical, f.lateral);
  if (const auto rv = middle(Role::rv_cavity);
      right && rv && dot(across(*rv), across(right->place)) < 0)
    fail(fmt::format("{} and {} lie on opposite sides of the left ventricle: correct their roles",
                     right->name, nameOfRole(Role::rv_cavity)));
}

void Finder::findAorta() {
  HeartFrame& f = marks_.frame;
  const double l = f.length_m;
  f.aortic = f.at(l * kAorticValve);
  f.aortic_flow = normalised(f.at(kAorticFlow) - f.origin);
  Facets aorta = facets(Role::aorta);
  if (aorta.empty()) aorta = facets(Role::aortic_wall);
  if (const auto valve = middle(Role::aortic_valve)) {
    f.aortic = *valve;
    marks_.aortic_found = true;
  } else if (!aorta.empty()) {
    const Contact root = contactOf(cavity_, aorta, kContact * l);
    marks_.aortic_found = root.gap < kTouching * l;
    if (marks_.aortic_found) f.aortic = root.middle;
  }
  // Into the root, where there is one: the vessel bends farther up.
  const Facets root = partAbove(
      aorta, [&](Vec3d p) { return -length(p - f.aortic); }, -0.45 * l);
  if (root.empty()) return lookFromBelow();
  const Vec3d flow = middleOf(root) - f.aortic;
  if (dot(flow, f.apical) < 0 && length(flow) > 0.05 * l) f.aortic_flow = normalised(flow);
}

// A valve without its vessel: flow is across its ring, where that is flat, and what can be seen of
// it is below the ring.
void Finder::lookFromBelow() {
  const Facets ring = facets(Role::aortic_valve);
  if (ring.empty()) return;
  HeartFrame& f = marks_.frame;
  const Vec3d widest = principalAxis(ring), next = principalAxis(ring, widest);
  const Vec3d flow = normalised(cross(widest, next));
  double along = 0, aside = 0;
  for (const Facet& facet : ring) {
    const Vec3d from = (1.0 / 3) * (facet[0] + facet[1] + facet[2]) - f.aortic;
    along += areaOf(facet) * std::abs(dot(from, flow));
    aside += areaOf(facet) * std::abs(dot(from, next));
  }
  if (along < kFlat * aside) f.aortic_flow = dot(flow, f.apical) < 0 ? flow : -flow;
  f.aortic = f.aortic - kBelowRing * f.length_m * f.aortic_flow;
}

}  // namespace

HeartMarks findHeart(const std::vector<RoleSurface>& surfaces, const SourcePlace& place) {
  return Finder(surfaces, place).find();
}

}  // namespace echocine
