#pragma once
// Cells of a model as a loop shows them: blood beside a wall is seen as wall, because echoes
// spread.

#include <span>
#include <vector>

#include "fit/fit_terms.h"

namespace echocine::fit {

// Moves the boundaries of blood by their visible displacement (Eq. 9 of echo_spread.h). A cell
// never loses more blood than it has, so sums over the cells remain a least-squares problem: a
// wrong model cannot have a residual near 0.
class SeenCells {
 public:
  explicit SeenCells(const ModelLoop& model, const FitStride& stride = {});

  // Begins with a frame's cells. number: of each cell among the strided ones, by line and depth;
  // empty: all cells in order.
  void start(std::span<const TissueCell> cells, std::span<const int> number = {});
  // Begins again with the cells of the last start().
  void restart(std::span<const TissueCell> cells) { cells_.assign(cells.begin(), cells.end()); }
  // Blood becomes the tissue beside it, up to `beside_m` from a piece of boundary. An edge outside
  // the blood (beside_m < 0) changes no cell.
  void take(const BoundaryPoint& p, double beside_m) { take(p, angleOf(p), beside_m); }
  // The same with the angle of angleOf(), which is the dearest part.
  void take(const BoundaryPoint& p, double angle_rad, double beside_m);
  static double angleOf(const BoundaryPoint& p);
  std::span<const TissueCell> cells() const { return cells_; }

 private:
  double bloodOf(const TissueCell& cell) const;
  void turn(TissueCell& cell, double share, std::uint8_t tissue) const;

  std::vector<double> blood_;  // by tissue: 1 or 0
  int across_, along_, cell_, piece_;
  double first_rad_, turn_rad_, near_m_, step_m_;  // of strided cells
  std::vector<int> at_;                            // by number: place in cells_; -1: none
  std::vector<TissueCell> cells_;
};

}  // namespace echocine::fit
