#pragma once
// Contours cut at the cells' boundaries: parts that lie in one cell each, with the pass of the
// cell's own line through the same surface.

#include <array>
#include <span>
#include <vector>

#include "geometry/plane_slice.h"
#include "trace/lanes.h"
#include "trace/line_trace.h"
#include "trace/trace_settings.h"

namespace echocine {

// Four parts. On each, from a to b, the path length does not fall. Points are in the imaging plane.
struct PartGroup {
  Lanes a_x, a_z, b_x, b_z;
  Lanes to_x, to_z;              // the direction in which it is seen at its middle, of any length
  Lanes n_x, n_z, n_square;      // its normal there, of any length, and the square of that
  Lanes Z_1, c_1, Z_2, c_2;      // of the media before and behind the interface
  Lanes passed, lobe, membrane;  // prod (1-R)^2 before it times the gain; n of cos^n; 1 or 0
  Lanes pass_path_m, pass_depth_m, path_per_depth, exponent, exponent_per_path;  // InterfacePass
  std::array<std::uint32_t, kLanes> line;
};

// Parts in groups of four; the last group may be filled in part.
struct CellParts {
  std::vector<PartGroup> groups;
  std::size_t count = 0;
};

class CellCutter {
 public:
  // Preconditions: as of addCellEchoes(); all arguments outlive the cutter.
  CellCutter(const Probe& probe, const TraceSettings& settings, std::span<const LineTrace> lines);

  // Appends the parts of one piece of contour. normals: of the piece, or nothing where the facet's
  // own counts.
  void cut(const ContourPiece& piece, const PieceNormals* normals, CellParts& parts) const;

 private:
  struct Point {
    double x, z;
  };
  struct Seen {  // a piece
    const ContourPiece& piece;
    const PieceNormals* smooth;
    Vec3d normal;  // of the facet, of any length
    double normal_square;
  };
  struct Sight {  // of its middle, from the line in whose cell it lies
    Vec3d to, normal;
    double normal_square;
    const InterfacePass& pass;
    std::uint32_t line;
  };
  struct PassLink {
    const InterfacePass* pass;
    std::uint32_t next;  // 1 + position in links_, or 0
  };

  double rightOf(Point p, int boundary) const;
  int cellOf(Point p) const;
  Point atBoundary(Point a, Point b, int boundary) const;
  void linkPasses();
  std::size_t keyOf(std::size_t line, SurfaceId surface, bool entering) const;
  const InterfacePass* nearestPass(std::size_t line, SurfaceId surface, bool entering,
                                   Point p) const;
  void addToLine(const Seen& seen, Point a, Point b, std::size_t line, CellParts& parts) const;
  void addPart(const Sight& sight, Point a, Point b, CellParts& parts) const;

  const Probe& probe_;
  const TraceSettings& settings_;
  std::span<const LineTrace> lines_;
  bool angular_;
  double first_, per_width_;
  std::vector<PassLink> links_;
  std::vector<std::uint32_t> heads_;  // by keyOf(): as PassLink::next
  std::vector<Point>
      boundaries_;  // sine and cosine, or the offset of a linear probe; one more than lines
};

// Width of a cell: an angle, or a length for a linear probe.
double cellWidth(const Probe& probe);

}  // namespace echocine
