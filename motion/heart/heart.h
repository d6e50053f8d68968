#pragma once
// The parametric beating heart: every structure at any phase.

#include <string>
#include <vector>

#include "motion/heart/control_mesh.h"
#include "motion/heart/heart_cycle.h"
#include "motion/heart/parameters.h"

namespace echocine::heart {

// Material and priority of a structure; the same at every phase.
struct PartKind {
  std::string name, medium;
  int priority = 0;  // the highest wins where closed parts overlap
  bool membrane = false;
  double reflection_exponent = 2;  // of its surface
};

// A structure's surface at one instant, in heart coordinates (left_ventricle.h), metres.
struct Part {
  PartKind kind;
  std::vector<Vec3d> points;  // on the surface, not yet control points
  std::vector<Face> faces;
};

// Landmarks for views and truth, at one instant.
struct Landmarks {
  Vec3d apex;                                  // of the left ventricle's cavity
  Vec3d mitral, tricuspid, aortic, pulmonary;  // centres of the valve rings
  Vec3d tricuspid_lateral;                     // end of that ring on the free wall, for TAPSE
  Vec3d aortic_flow;                           // unit, from the ventricle into the aorta
  double mitral_radius_m = 0, tricuspid_radius_m = 0;
  double twist_rad = 0;                              // of the apex relative to the base
  std::array<double, kSegments> wall_thickness_m{};  // at the centre of each segment
};

// Both at one instant.
struct Shape {
  std::vector<Part> parts;
  Landmarks places;
};

class ParametricHeart {
 public:
  // Throws SceneError if no shape fulfils the parameters. Precondition: faultOf(parameters) is
  // empty.
  explicit ParametricHeart(const Parameters& parameters);

  // Every part at a phase in [0, 1), always in the same order with the same faces. Throws like the
  // constructor.
  std::vector<Part> at(double phase) const;
  Landmarks landmarksAt(double phase) const;
  Shape shapeAt(double phase) const;  // at half the cost of two separate calls

  const Parameters& parameters() const { return parameters_; }
  const Cycle& cycle() const { return cycle_; }
  double lvLength() const { return at_rest_.length(); }  // at end-diastole, m
  // Centre of the heart, which is star-shaped about it except for the great vessels.
  Vec3d centre() const;

 private:
  Parameters parameters_;
  Cycle cycle_;
  LeftVentricle at_rest_;
};

}  // namespace echocine::heart
