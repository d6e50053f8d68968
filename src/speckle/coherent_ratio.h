#pragma once
// From echo sums and the deterministic picture to the picture with speckle:
//   I = Ibar smooth(|g|^2 / w),  g = h * (sqrt(Ibar) U),  w = h^2 * (Ibar P),
// with U, P the echo sums, h the separable point spread function over samples and lines. g and w
// take in the very same samples, so that E|g|^2 = w exactly and the mean over seeds is Ibar.
// Where the part q = Ic / Ibar of a sample is coherent, of phase phi:
//   I = Ibar smooth(|sqrt(1 - q) g / sqrt(w) + sqrt(q) exp(j phi)|^2), of the same mean.

#include <span>
#include <vector>

#include "speckle/splat.h"
#include "trace/coherent_echoes.h"

namespace echocine {

// Rows stand on whole ones.
struct alignas(64) CacheLine {
  float floats[16];
};

class CoherentRatio {
 public:
  CoherentRatio(const Probe& probe, const PointSpread& spread, const BeamView& view,
                double smoothing_m);

  // Memory of one frame in the making.
  struct Rows {
    std::vector<CacheLine> raw;      // one line's real, imaginary, squares, with zeros about them
    std::vector<CacheLine> lines;    // lines that have been smeared along, used round
    std::vector<CacheLine> ratios;   // those of a group of lines, with their ends repeated
    std::vector<CacheLine> nothing;  // a line beyond the sector
    std::vector<CacheLine> echoes;   // their sqrt(1 - q), and real and imaginary of sqrt(q)
  };

  // Lines whose sums and intensities those of a range take in.
  LineRange reach(LineRange lines) const;

  // A range of lines in place, from the splats of their reach. Where no scatterer is in reach the
  // picture stays as it is. echoes: what of the intensities is coherent, sample by sample; empty:
  // nothing.
  void apply(const SplatLists& scattered, Rows& rows, std::span<float> intensities,
             const CoherentEchoes& echoes, LineRange lines) const;

 private:
  void alongLine(std::span<const Splat> scattered, const float* intensities, Rows& rows,
                 float* smeared) const;
  void shareOut(const CoherentEchoes& echoes, int line, const float* intensities,
                float* shares) const;
  template <bool even, bool coherent>
  void acrossLines(LineRange group, Rows& rows) const;
  void finish(float* ratio, float* intensities) const;
  float* smeared(Rows& rows, int line) const;
  float* ratioOf(Rows& rows, int member) const;
  float* echoesOf(Rows& rows, int member) const;

  int lines_, samples_;
  std::size_t length_, stride_;                   // of a row: whole steps, and to the next one
  std::vector<float> axial_, axial_squares_;      // h and h^2 of distance 0, 1, ...
  std::vector<float> smoothing_;                  // of the ratio
  std::size_t lateral_taps_ = 0;                  // beside the middle one
  bool even_ = false;                             // the same at all depths
  std::vector<float> lateral_, lateral_squares_;  // by distance, then sample
};

}  // namespace echocine
