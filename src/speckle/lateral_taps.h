#pragma once
// Sums of the grid's rows for one line, sample by sample: h_m of splat_grid.h.

#include <vector>

#include "speckle/splat_grid.h"

namespace echocine {

// g and w of a line's samples.
struct LineSums {
  float *real, *imaginary, *power;
};

class LateralTaps {
 public:
  LateralTaps(const SplatGrid& grid, int samples);

  // Rows that a line takes: `rows().count` from this one on.
  int firstRow(int line) const { return line / period_lines_ * period_rows_ + range_.first; }
  TapRange rows() const { return range_; }

  // Samples [from, to) of a line's sums, in whole eights. Precondition: a piece begins at `from`,
  // and `to` is within it. rows: those of the line, as AxialSums leaves them.
  static constexpr std::ptrdiff_t kPiece = 64;
  void sum(const float* const* rows, int line, std::ptrdiff_t from, std::ptrdiff_t to,
           const LineSums& sums) const;

 private:
  void fitEven(double deviation, double phase);
  void fitPieces(const std::vector<double>& deviations, double phase);
  template <bool even>
  void sumRows(const float* const* rows, const float* taps, int count, std::ptrdiff_t from,
               std::ptrdiff_t to, const LineSums& sums) const;

  int period_lines_, period_rows_;
  bool even_;
  std::ptrdiff_t samples_;  // whole eights
  TapRange range_;          // of all lines between two rows
  // Taps of a line between two rows: of all samples, or of those of a piece.
  struct Piece {
    TapRange range;
    std::size_t first;
  };
  std::size_t pieces_;         // of a line
  std::vector<Piece> phases_;  // by line between two rows, and piece
  // For each row: h, h, h_m^2, h_m h_(m+1) twice, or by sample of the piece.
  std::vector<CacheLine> even_taps_;
  std::vector<Floats4> taps_;
};

}  // namespace echocine
