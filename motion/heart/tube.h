#pragma once
// A vessel: a closed tube along a curved line.

#include <vector>

#include "core/box.h"
#include "core/lanes.h"
#include "core/vec3.h"

namespace echocine::heart {

class Tube {
 public:
  struct Station {
    Vec3d centre;
    double radius_m;
  };

  // A smooth line through the stations (Catmull-Rom) with rounded ends. Precondition: at least
  // three stations.
  explicit Tube(const std::vector<Station>& stations);

  // For a direction of the unit sphere, z towards the last station; dilated by `thickness_m`, with
  // fixed ends.
  Vec3d point(Vec3d direction, double thickness_m = 0) const;
  // Moves each point away from the line until it is at least `gap_m` outside.
  void pushOut(double gap_m, std::vector<Vec3d>& points) const;

 private:
  struct Section {
    Vec3d centre, u, v;
    double radius_m;
  };
  Section at(double share) const;
  // The nearest section; null if all are farther than `far_m`.
  const Section* nearest(Vec3d point, double far_m) const;

  // Coordinates of the centres of four sections, for evaluation in parallel lanes.
  struct Four {
    Doubles4 x, y, z;
    Doubles4 squares(Vec3d point) const {
      const Doubles4 dx = point.x - x, dy = point.y - y, dz = point.z - z;
      return dx * dx + dy * dy + dz * dz;
    }
  };
  static std::vector<Four> foursOf(const std::vector<Vec3d>& centres);

  std::vector<Section> sections_;  // evenly spaced by arc length
  // Unused lanes of the last four lie at infinity. The stretches are runs of sections; hub_reach_m_
  // is the largest distance of a section from the hub of its stretch.
  std::vector<Four> fours_, hubs_;
  double hub_reach_m_ = 0;
  double length_m_ = 0;
  Box centres_m_;
  double most_radius_m_ = 0;
};

}  // namespace echocine::heart
