#pragma once
// Contours cut at the boundaries between the lines' cells.

#include <array>
#include <span>
#include <vector>

#include "core/lanes.h"
#include "geometry/plane_slice.h"

namespace echocine {

// So many parts go through all steps together: what lies between these stays in the first-level
// cache.
inline constexpr std::size_t kParts = 128;
// A part on which the path length turns round becomes two. One cache line more, lest the rows'
// equal places share a set of the cache: without it 256 parts take twice the time.
template <typename T>
using PartRow = std::array<T, 2 * kParts + 64 / sizeof(T)>;

// Parts of contour, each inside the cell of one line; in rows, for lanes. Points and vectors are in
// the imaging plane.
struct CellParts {
  std::size_t count = 0;
  PartRow<double> a_x, a_z, b_x, b_z;  // its ends; b is no nearer to the centre (no shallower)
  PartRow<double> to_x, to_z;          // direction in which its middle is seen, of any length
  PartRow<double> normal_x, normal_z;  // of the facet, of any length,
  PartRow<double> normal_square;       // and the square of that
  PartRow<std::int64_t> entering;      // -1: seen so, the facet's outside is in front; else 0
  PartRow<std::int64_t> turns;         // -1: the foot of the perpendicular from the centre is on it
  PartRow<std::uint32_t> piece, line;
};

// Cuts pieces in their order.
class CellCutter {
 public:
  // Preconditions: the probe has two lines at least; the pieces outlive the cutter.
  CellCutter(const Probe& probe, std::span<const ContourPiece> pieces);

  // Width of a cell: an angle, or a length for a linear probe.
  double width() const { return width_; }

  // The next parts; none at the end.
  void next(CellParts& parts);

 private:
  struct Boundary {
    double sine, cosine;  // of a linear probe: its offset and 1
  };
  // Ends of pieces, in the cells begin to end; of these the sector has those from begin on.
  static constexpr std::size_t kPieces = 64;
  struct Ends {
    std::array<double, kPieces> a_x, a_z, b_x, b_z;
    std::array<std::int32_t, kPieces> begin, end;
    std::array<std::uint32_t, kPieces> piece;
    std::size_t count = 0, done = 0;
  };
  // What parts are cut from besides the ends of their pieces.
  struct Sides {
    std::array<double, kParts> left_sine, left_cosine, right_sine, right_cosine;
  };

  void takeEnds();
  void findCells();
  Doubles4 placeOf(Doubles4 x, Doubles4 z) const;
  double rightOf(double x, double z, int boundary) const;
  int cellOf(double x, double z, int guess) const;
  void intoCells(CellParts& parts);
  Doubles4 rightOf(Doubles4 x, Doubles4 z, Doubles4 sine, Doubles4 cosine) const;
  void cutAtBoundaries(CellParts& parts) const;

  std::span<const ContourPiece> pieces_;
  std::size_t taken_ = 0;  // of the pieces
  bool angular_;
  int lines_;
  double first_, width_, per_width_;
  double unsure_;                     // error of a place, in cells
  std::vector<Boundary> boundaries_;  // one more than lines
  Ends ends_;
  Sides sides_;
};

}  // namespace echocine
