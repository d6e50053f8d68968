#pragma once
// Sorts the scatterers' splats by line, each at the sample nearest to it: what the point spread
// function then smears.

#include <cstdint>
#include <span>
#include <vector>

#include "core/beam_plane.h"
#include "speckle/scatterers.h"

namespace echocine {

// Of one scatterer: c e exp(-2j k0 r), its real and imaginary part, and e^2.
struct Splat {
  float real, imaginary, square;
  std::int32_t sample;
};

// A frame's splats by line, each line's in the order in which they came. They are written and read
// one after the other, so that a frame's sums need never be in memory all at once.
class SplatLists {
 public:
  // No splats yet; from now on those of some of the lines are kept.
  void start(int lines, LineRange kept) {
    lists_.resize(static_cast<std::size_t>(lines));
    for (List& list : lists_) list.next = list.memory.data();
    first_ = static_cast<float>(kept.first);
    end_ = static_cast<float>(kept.end);
  }
  Ints8 keeps(Floats8 line) const { return (line >= first_) & (line < end_); }

  // Of lanes that are seen (-1, else 0). Every line is one of the frame's.
  void add(const Splat* splats, Ints8 lines, Ints8 seen);

  std::span<const Splat> line(int i) const {
    const List& list = lists_[static_cast<std::size_t>(i)];
    return {list.memory.data(), list.next};
  }

 private:
  struct List {
    Splat *next = nullptr, *end = nullptr;
    std::vector<Splat> memory;
  };
  static void grow(List& list);
  std::vector<List> lists_;
  float first_ = 0, end_ = 0;
};

// The Gaussian numbers of a batch at an instant: a mix of two draws, of variance 1.
struct GaussianMix {
  const float *real_a, *imaginary_a, *real_b, *imaginary_b;
  float a = 1, b = 0;
  // Factors of amplitude by scatterer, or none. What the ratio is normalised by is without them.
  const float* strength = nullptr;

  Floats8 real(std::uint32_t j) const { return weighed(j, mixed(real_a + j, real_b + j)); }
  Floats8 imaginary(std::uint32_t j) const {
    return weighed(j, mixed(imaginary_a + j, imaginary_b + j));
  }

 private:
  Floats8 weighed(std::uint32_t j, Floats8 c) const {
    return strength ? lanesAt(strength + j) * c : c;
  }
  Floats8 mixed(const float* one, const float* two) const {
    return b == 0 ? lanesAt(one) : a * lanesAt(one) + b * lanesAt(two);
  }
};

// Which draws: c(t) = cos(pi f/2) c_m + sin(pi f/2) c_(m+1) with m + f = t / tau + a batch's own
// phase, so that no instant renews all at once. tau = 0: never renewed.
GaussianMix mixAt(const GaussianTable& table, std::uint64_t pattern, double time_s, double tau_s);

class Splatter {
 public:
  Splatter(const Probe& probe, const PointSpread& spread);

  // The scatterers of a cube whose corners are here now. Phases hold the path and, across the
  // imaging plane, the curvature of the lens's wave, which makes the correlation after a shift d
  // exp(-d^2 / 2 s0^2) at every depth, s0 the deviation by diffraction alone.
  void add(const BeamCube& cube, const Scatterers& scatterers, const ScattererBatch& batch,
           const GaussianMix& mix, SplatLists& splats) const;

  // Eight scatterers at their own places, with the mix's numbers from `j` on.
  void addPlaces(const BeamCube& at, const GaussianMix& mix, std::uint32_t j,
                 SplatLists& splats) const;

 private:
  // Turns that the lens adds at the cut, over a cube's samples.
  struct Bend {
    float first, slope;
  };
  Bend bendOf(Floats8 sample) const;
  void addLanes(const BeamCube& at, const Bend& bend, const GaussianMix& mix, std::uint32_t j,
                SplatLists& splats) const;

  int samples_;
  float turns_per_sample_, turns_before_;
  double min_depth_m_, spacing_m_, lens_, focus_m_;
};

}  // namespace echocine
