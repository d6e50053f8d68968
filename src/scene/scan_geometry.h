#pragma once
// Positions of a probe's lines and samples, both ways: the only place that knows the kinds of
// probes. All kinds space their lines evenly along one coordinate, their `place`: an angle for
// lines that meet in the apex, an offset (m) for parallel lines.

#include <optional>
#include <vector>

#include "core/box.h"
#include "core/vec3.h"
#include "scene/probe.h"

namespace echocine {

// Start and unit direction of a scan line in the probe frame; path lengths count from `origin`.
struct LineGeometry {
  Vec3d origin;
  Vec3d direction;
};

// Line i of N has the place first + i (last - first)/(N - 1), edges included; a single line is in
// the middle. Line i of a full turn has the angle -pi + (i + 1/2) 2 pi/N.
LineGeometry lineGeometry(const Probe& probe, int line);

// Distance between neighbouring scan lines at a path length; 0 for a single line.
double lineSpacing(const Probe& probe, double depth_m);

// Does a point of the imaging plane lie between the outermost lines and their first and last
// samples?
bool inScanArea(const Probe& probe, double x_m, double z_m);

// Outline of the scan area, clockwise in the picture: convex for sectors up to 180 degrees and for
// a full turn; the arc of the deepest samples is a fine polygon. The arc of the face is omitted.
std::vector<Vec3d> sectorOutline(const Probe& probe);

// Box of the scan area, from the first to the last samples, in the probe frame.
Box scanBox(const Probe& probe);

class ScanGeometry {
 public:
  explicit ScanGeometry(const Probe& probe);

  bool angular() const { return angular_; }  // lines meet in the apex
  // The last line is a neighbour of the first.
  bool fullTurn() const { return probe_.isFullTurn(); }

  // Place of the first line: rad, or m.
  double firstPlace() const { return first_place_; }
  double lastPlace() const { return last_place_; }
  double placeOf(Vec3d point_m) const;  // of a point of the imaging plane
  // Path length of a point from the start of the line through it.
  double pathOf(Vec3d point_m) const;

  // Spacing of lines: the width of a beam's cell. Precondition: at least two lines.
  double cellWidth() const;
  // An angle across the lines, in lines. For parallel lines it is an arc at the middle depth.
  // Precondition: at least two lines.
  double linesAcross(double angle_rad) const {
    return (angular_ ? angle_rad : angle_rad * probe_.middleDepth()) / cellWidth();
  }
  // Start of the cell of line i, half a width before the line; that of `lines` is the end of the
  // last cell.
  double cellBorder(int line) const { return first_place_ + (line - 0.5) * cellWidth(); }

  // Fractional line (0 to lines - 1) and path length of a point; none outside the lines. Over a
  // full turn lines count up to, but not including, `lines`, which is line 0 again.
  struct BeamPosition {
    double line = 0, path_m = 0;  // line: lines from the first
  };
  std::optional<BeamPosition> beamPosition(double x_m, double z_m) const;
  // The number of the line nearest to a fractional one.
  int nearestLine(double line) const;
  // The same for a point beside another one whose place is known: within 1e-11 rad of it, and
  // faster, because a small angle needs no arc tangent.
  std::optional<BeamPosition> beamPositionBeside(Vec3d known_m, double known_place,
                                                 Vec3d point_m) const;

  // The depth of a sample's centre: min_depth + (k + 1/2) spacing.
  double sampleDepth(int sample) const {
    return probe_.min_depth_m + (sample + 0.5) * probe_.sampleSpacing();
  }

  // The wavelength for focusing and beam width, m.
  double wavelength() const { return kScannerSpeed / probe_.frequency_hz; }

 private:
  std::optional<BeamPosition> at(double place, double path_m) const;

  Probe probe_;
  bool angular_;
  double first_place_, last_place_;
};

}  // namespace echocine
