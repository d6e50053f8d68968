#pragma once
// From splats and the deterministic picture to the picture with speckle:
//   I = Ibar smooth(|g|^2 / w),
// with g and w the sums of splat_grid.h. w is the mean of |g|^2 over seeds: exact across the lines,
// and along them within 0.1 % where the picture is even. Beside an edge of the picture it is within
// 14 % where the brighter side leaves over 0.1 % of its power. The mean over seeds is thus Ibar.
// Where the part q = Ic / Ibar of a sample is coherent, with phase phi, the mean stays the same:
//   I = Ibar smooth(|sqrt(1 - q) g / sqrt(w) + sqrt(q) exp(j phi)|^2).

#include <span>
#include <vector>

#include "speckle/axial_sums.h"
#include "speckle/lateral_taps.h"
#include "speckle/line_smoothing.h"
#include "speckle/splat_grid.h"
#include "trace/coherent_echoes.h"
#include "trace/echo_field.h"

namespace echocine {

class CoherentRatio {
 public:
  CoherentRatio(const Probe& probe, const PointSpread& spread, const BeamView& view,
                double smoothing_m);

  // Memory of one frame in progress.
  struct Rows {
    SplatGrid::Rows grid;
    std::vector<CacheLine> smeared;  // along the lines: a ring of rows
    int next_smeared = 0;            // the first row that is not
    std::vector<CacheLine> sums;     // of a group of lines
    std::vector<CacheLine> ratio;    // of one line, with margins, and smoothed
    std::vector<CacheLine> echoes;   // its sqrt(1 - q), and real and imaginary part of sqrt(q)
    std::vector<CacheLine> field;    // its real and imaginary part of the sum, of unit mean power
    std::vector<float> coarse;
  };

  // Lines whose splats and intensities those of a range take.
  LineRange reach(LineRange lines) const { return within(lines, beside_ + 1); }

  // A range of lines in place, from the splats of their reach. Where no scatterer is in reach the
  // picture stays as it is. echoes: the coherent part of the intensities, by sample; empty: none.
  // field: if not null and not empty, receives that of the lines.
  void apply(const SplatLists& scattered, Rows& rows, std::span<float> intensities,
             const CoherentEchoes& echoes, LineRange lines, EchoField* field = nullptr) const;

 private:
  LineRange within(LineRange lines, int beside) const;
  void start(LineRange lines, Rows& rows) const;
  void sumGroup(LineRange group, Rows& rows) const;
  const float* smearedRow(int row, Rows& rows) const;
  LineSums sumsOf(int line_of_group, Rows& rows) const;
  void shareOut(const CoherentEchoes& echoes, int line, const float* intensities,
                float* shares) const;
  void ratioOf(const LineSums& sums, float* ratio) const;
  void fieldOf(const LineSums& sums, const float* echoes, float* ratio, float* field) const;
  void keep(const float* unit, int line, const float* intensities, EchoField& field) const;
  void finish(Rows& rows, float* intensities) const;
  float* ratio(Rows& rows) const;

  int lines_, samples_;
  SplatGrid grid_;
  LateralTaps lateral_;
  AxialSums axial_;
  LineSmoothing smoothing_;
  std::ptrdiff_t length_;  // of a row of samples: that of a smoothed line
  std::ptrdiff_t stride_;  // floats of a smeared row
  int slots_;              // smeared rows that a group of lines takes
  int beside_;             // lines to either side whose splats a line takes
};

}  // namespace echocine
