#pragma once
// Sums of splats over the point spread function, line by line:
//   g(i, k) = sum_s sqrt(I_s) c_s e_s H_s(i) h(k - k_s),  w(i, k) = sum_s I_s e_s^2 H_s(i)^2 h^2,
// I_s the picture at the sample nearest to scatterer s, k_s its place between samples. Along the
// line h is a bell about k_s itself. Across the lines there are rows on each line and, where cells
// are narrow, between lines, at most half a deviation apart; H_s = (1 - t) h_m + t h_(m+1), for a
// scatterer at t between rows m and m + 1. g and w take in the very same taps.

#include <span>
#include <vector>

#include "core/beam_plane.h"
#include "speckle/beam_view.h"
#include "speckle/splat_lists.h"
#include "speckle/tap_table.h"

namespace echocine {

// Rows stand on whole ones.
struct alignas(64) CacheLine {
  float floats[16];
};

class SplatSums {
 public:
  SplatSums(const Probe& probe, const PointSpread& spread, const BeamView& view);

  // Lines that are summed at once.
  static constexpr int kGroup = 4;

  // Memory of one frame in the making.
  struct Rows {
    std::vector<CacheLine> rows;    // of splats smeared along the line, used round
    std::vector<CacheLine> sums;    // of a group of lines
    std::vector<float> amplitudes;  // of the picture's line that is added
    int next = 0;                   // row that was not begun
  };
  // Of one line: real and imaginary part of g, and w. Whole steps of 32 may be read.
  struct Line {
    const float *real, *imaginary, *squares;
  };

  // Lines whose splats those of a range take in.
  LineRange reach(LineRange lines) const;

  void start(LineRange lines, Rows& rows) const;
  // Precondition: called for the lines of reach(lines), one after the other.
  void add(std::span<const Splat> splats, int line, const float* intensities, Rows& rows) const;
  // Sums of at most kGroup lines. Precondition: their reach was added.
  void sum(LineRange group, Rows& rows) const;
  Line line(const Rows& rows, int member) const;

 private:
  float* row(Rows& rows, int number) const;
  int rowBefore(double line) const;
  template <int eights, int fours>
  void addAll(std::span<const Splat> splats, int line, const float* intensities, Rows& rows) const;
  template <bool even>
  void sumRows(LineRange group, Rows& rows) const;

  int lines_, samples_;
  int rows_per_line_ = 1;
  std::ptrdiff_t length_, pad_, stride_;  // of a row: whole steps, ahead of it, and to the next
  TapTable axial_;
  int taps_ = 0;                          // rows either side
  bool even_ = false;                     // the same at all depths
  std::vector<float> lateral_, squares_;  // by distance in rows, then sample
  std::vector<float> cross_;              // by sample
};

}  // namespace echocine
