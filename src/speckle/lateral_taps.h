#pragma once
// Sums of the grid's rows for one line: h_m of splat_grid.h.

#include <vector>

#include "speckle/splat_grid.h"

namespace echocine {

class LateralTaps {
 public:
  explicit LateralTaps(const SplatGrid& grid);

  // Rows that a line takes: `rows().count` from this one on.
  int firstRow(int line) const { return line / lines_per_row_ * rows_per_line_ + range_.first; }
  TapRange rows() const { return range_; }

  // Nodes [from, to) of a line's sums, between -kBeside and kBeside behind the last. rows: those of
  // the line.
  static constexpr std::ptrdiff_t kPiece = 64;
  // Nodes that splines reach ahead of the first sample and behind the last one, and more.
  static constexpr std::ptrdiff_t kBeside = 8;
  void sum(const float* const* rows, int line, std::ptrdiff_t from, std::ptrdiff_t to,
           float* sums) const;

 private:
  void fit(const SplatGrid& grid, double phase);
  template <bool even>
  void sumNodes(const float* const* rows, const float* taps, int count, std::ptrdiff_t from,
                std::ptrdiff_t to, float* sums) const;

  int lines_per_row_, rows_per_line_;
  bool even_;
  std::ptrdiff_t nodes_;
  TapRange range_;  // of all lines between two rows
  struct Phase {
    TapRange range;     // of one of them
    std::size_t first;  // of its taps
  };
  std::vector<Phase> phases_;
  // For each row: h, h, h_m^2, h_m h_(m+1) twice, or by node.
  std::vector<CacheLine> even_taps_;
  std::vector<Floats4> taps_;
};

}  // namespace echocine
