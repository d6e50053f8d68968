#pragma once
// How a probe is held for each standard view, whichever heart stands before it. The only place that
// says so: the parametric heart and the hearts of scenes are both aimed at by these rules.

#include <span>

#include "core/vec3.h"
#include "scene/view_placement.h"

namespace echocine {

// A heart's own axes and the places by which views are aimed, at end-diastole. World, metres.
struct HeartFrame {
  Vec3d origin;             // the middle of the mitral ring
  Vec3d lateral{1, 0, 0};   // unit, across one another: from the septum to the lateral wall,
  Vec3d anterior{0, 1, 0};  // to the anterior wall,
  Vec3d apical{0, 0, 1};    // and along the long axis to the apex; left-handed in a mirrored heart
  double length_m = 0;      // of the left ventricle's long axis
  double scale = 1;         // of the body: 1 for an adult's
  Vec3d apex, mitral, aortic;  // of the left ventricle's cavity; middles of the valves
  Vec3d aortic_flow;           // unit, from the ventricle into the aorta

  // The direction at an angle about the long axis: 0 lateral, 90 deg anterior, 180 deg septal.
  Vec3d about(double phi_rad) const;
  // From lateral towards anterior, rad.
  double angleOf(Vec3d place) const;
  // A place by its coordinates along the three axes, m.
  Vec3d at(Vec3d place_m) const;
};

// The image has `lateral` to the right and `axis` downwards. As by convention apical views have the
// left ventricle on the right, parasternal long axes the aorta on the right, short axes the septum
// on the left and are seen from the apex.
struct ProbePose {
  Vec3d apex;           // of the sector, on the skin
  Vec3d axis, lateral;  // unit, across each other
  double depth_m = 0, sector_deg = 0;
  double chest_m = 0;  // from the skin to the pericardium, at end-diastole
};

// The probe on the skin: the chest's thickness before the outermost of `outside_m` in the beam's
// middle, and as deep as all of them in the image need. wall_m: of what lies between these points
// and the heart's surface. front_m: what a parasternal probe stands before, in place of all.
ProbePose standardPose(View view, const HeartFrame& heart, std::span<const Vec3d> outside_m,
                       double wall_m = 0, std::span<const Vec3d> front_m = {});

// The path length from the apex that shows all points of the image, within `half_rad` of the axis.
double fittingDepth(std::span<const Vec3d> outside_m, const ProbePose& pose, double half_rad,
                    double scale);

}  // namespace echocine
