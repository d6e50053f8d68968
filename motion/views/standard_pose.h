#pragma once
// Rules for the probe pose of each standard view: the only place that defines them, for parametric
// hearts and for hearts of scenes.

#include <span>

#include "core/vec3.h"
#include "motion/views/facets.h"
#include "scene/view_placement.h"

namespace echocine {

// A heart's axes and landmarks for views, at end-diastole. World, metres.
struct HeartFrame {
  Vec3d origin;             // centre of the mitral ring
  Vec3d lateral{1, 0, 0};   // unit, orthogonal: from the septum to the lateral wall,
  Vec3d anterior{0, 1, 0};  // to the anterior wall,
  Vec3d apical{0, 0, 1};    // and along the long axis to the apex; left-handed in a mirrored heart
  double length_m = 0;      // of the left ventricle's long axis
  double scale = 1;         // of the body: 1 for an adult's
  Vec3d apex, mitral, aortic;    // of the left ventricle's cavity; centres of the valves
  Vec3d aortic_flow;             // unit, from the ventricle into the aorta
  bool has_left_atrium = false;  // or its wall, or a pericardium: behind the base

  // The direction at an angle about the long axis: 0 lateral, 90 deg anterior, 180 deg septal.
  Vec3d about(double phi_rad) const;
  // From lateral towards anterior, rad.
  double angleOf(Vec3d place) const;
  // A place by its coordinates along the three axes, m.
  Vec3d at(Vec3d place_m) const;
};

// The image has `lateral` to the right and `axis` downwards. By convention apical views have the
// left ventricle on the right, parasternal long axes the aorta on the right, and short axes the
// septum on the left, seen from the apex.
struct ProbePose {
  Vec3d apex;           // of the sector, on the skin or in the oesophagus
  Vec3d axis, lateral;  // unit, orthogonal
  double depth_m = 0, sector_deg = 0;
  double chest_m = 0;  // from the skin to the pericardium, at end-diastole
};

// The imaging plane of a view.
struct StandardPlane {
  Vec3d normal, axis;  // unit: across the plane; of the beam, in it
  // In the plane: of a long axis, the place nearest to the middle of the ventricle; of a short
  // axis, the place that the view looks at.
  Vec3d centre;
  bool short_axis = false;  // if not, the plane is parallel to the long axis
};
StandardPlane standardPlane(View view, const HeartFrame& heart);

// The probe on the skin: at the thickness of the chest in front of the outermost of `outside_m` in
// the centre of the beam, and deep enough for all of it in the image. wall_m: thickness between
// this surface and the heart's. front_m: what lies in front of a parasternal probe, instead of all.
ProbePose standardPose(View view, const HeartFrame& heart, std::span<const Facet> outside_m,
                       double wall_m = 0, std::span<const Facet> front_m = {});

// The path length from the apex that contains the surface in the image, within `half_rad` of the
// axis: at most a right angle, or pi for all round.
double fittingDepth(std::span<const Facet> outside_m, const ProbePose& pose, double half_rad,
                    double scale);

// The same for lines along the axis, at lateral places from first_m to last_m.
double fittingDepth(std::span<const Facet> outside_m, const ProbePose& pose, double first_m,
                    double last_m, double scale);

}  // namespace echocine
