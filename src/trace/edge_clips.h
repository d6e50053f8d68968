#pragma once
// Contours cut at the boundaries between the lines' cells.

#include <array>
#include <span>
#include <vector>

#include "core/lanes.h"
#include "geometry/plane_slice.h"

namespace echocine {

// Number of clips processed together: their intermediate data fit the first-level cache.
inline constexpr std::size_t kClips = 128;
// A clip on which the path length has a minimum becomes two. One extra cache line, so that equal
// indices of different rows do not share a cache set: without it 256 clips take twice the time.
template <typename T>
using ClipRow = std::array<T, 2 * kClips + 64 / sizeof(T)>;

// Clips of contour, each inside the cell of one line, in rows for lanes. Points and vectors are in
// the imaging plane.
struct EdgeClips {
  std::size_t count = 0;
  ClipRow<double> a_x, a_z, b_x, b_z;  // its ends; b is no nearer to the centre (no shallower)
  ClipRow<double> to_x, to_z;          // viewing direction of its centre, of any length
  ClipRow<double> normal_x, normal_y, normal_z;  // of the facet, of any length,
  ClipRow<double> normal_square;                 // and the square of that
  ClipRow<std::int64_t> entering;  // -1: seen so, the facet's outside is in front; else 0
  ClipRow<std::int64_t> turns;     // -1: the foot of the perpendicular from the centre is on it
  ClipRow<std::uint32_t> edge, line;
};

// Cuts edges in the given order.
class EdgeClipper {
 public:
  // Preconditions: the probe has at least two lines; the edges outlive the clipper.
  EdgeClipper(const Probe& probe, std::span<const ContourEdge> edges);

  // Width of a cell: an angle, or a length for a linear probe.
  double width() const { return width_; }

  // The next clips; none at the end.
  void next(EdgeClips& clips);

 private:
  struct Boundary {
    double sine, cosine;  // of a linear probe: its offset and 1
  };
  // Ends of edges, in the cells begin to end; those in the sector start at begin. Over a full turn
  // the end may be a turn farther: cell n + lines is cell n.
  static constexpr std::size_t kEdges = 64;
  struct Ends {
    std::array<double, kEdges> a_x, a_z, b_x, b_z;
    std::array<std::int32_t, kEdges> begin, end;
    std::array<std::uint32_t, kEdges> edge;
    std::size_t count = 0, done = 0;
  };
  // Sides of clips other than the ends of their edges.
  struct Sides {
    std::array<double, kClips> left_sine, left_cosine, right_sine, right_cosine;
  };

  void takeEnds();
  void takeOneAhead(Vec3d a, Vec3d b);
  void takeOneAround(Vec3d a, Vec3d b);
  void takeOne(Vec3d a, Vec3d b);
  void findCells();
  Doubles4 placeOf(Doubles4 x, Doubles4 z) const;
  double rightOf(double x, double z, int boundary) const;
  int cellOf(double x, double z, int guess) const;
  void intoCells(EdgeClips& clips);
  Doubles4 rightOf(Doubles4 x, Doubles4 z, Doubles4 sine, Doubles4 cosine) const;
  void cutAtBoundaries(EdgeClips& clips) const;

  std::span<const ContourEdge> edges_;
  std::size_t taken_ = 0;  // of the edges
  bool angular_, full_turn_;
  int lines_;
  double first_, width_, per_width_;
  double unsure_;                     // error of a place, in cells
  std::vector<Boundary> boundaries_;  // one more than lines
  Ends ends_;
  Sides sides_;
};

}  // namespace echocine
