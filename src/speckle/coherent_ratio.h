#pragma once
// From echo sums and the deterministic picture to the picture with speckle:
//   I = Ibar smooth(|g|^2 / w),
// with g, w the sums of the scatterers (splat_sums.h). E|g|^2 = w exactly, so that the mean over
// seeds is Ibar. Where the part q = Ic / Ibar of a sample is coherent, of phase phi:
//   I = Ibar smooth(|sqrt(1 - q) g / sqrt(w) + sqrt(q) exp(j phi)|^2), of the same mean.

#include <span>
#include <vector>

#include "speckle/line_smoothing.h"
#include "speckle/splat_sums.h"
#include "trace/coherent_echoes.h"

namespace echocine {

class CoherentRatio {
 public:
  CoherentRatio(const Probe& probe, const PointSpread& spread, const BeamView& view,
                double smoothing_m);

  // Memory of one frame in the making.
  struct Rows {
    SplatSums::Rows sums;
    std::vector<CacheLine> ratio;   // of one line, with margins, and smoothed
    std::vector<CacheLine> echoes;  // its sqrt(1 - q), and real and imaginary part of sqrt(q)
    std::vector<float> coarse;
  };

  // Lines whose sums and intensities those of a range take in.
  LineRange reach(LineRange lines) const { return sums_.reach(lines); }

  // A range of lines in place, from the splats of their reach. Where no scatterer is in reach the
  // picture stays as it is. echoes: what of the intensities is coherent, sample by sample; empty:
  // nothing.
  void apply(const SplatLists& scattered, Rows& rows, std::span<float> intensities,
             const CoherentEchoes& echoes, LineRange lines) const;

 private:
  void shareOut(const CoherentEchoes& echoes, int line, const float* intensities,
                float* shares) const;
  template <bool coherent>
  void ratioOf(const SplatSums::Line& sums, const float* echoes, float* ratio) const;
  void finish(Rows& rows, float* intensities) const;
  float* ratio(Rows& rows) const;

  int samples_;
  std::size_t length_;  // of a row: whole groups of lanes
  SplatSums sums_;
  LineSmoothing smoothing_;
};

}  // namespace echocine
