#pragma once
// Adds scatterers up at the samples nearest to them: what the point spread function then smears.

#include <cstdint>
#include <vector>

#include "core/beam_plane.h"
#include "speckle/scatterers.h"

namespace echocine {

// One sample: sum of c e exp(-2j k0 r), its real and imaginary part, and sum of e^2. One load and
// store for each scatterer.
struct EchoSum {
  float real = 0, imaginary = 0, squares = 0, unused = 0;
};

// Line-major sums of a frame. Between frames all are
// 0: who reads them clears them, while they are at hand.
class EchoSums {
 public:
  // From one line to the next. Whole cache lines, an odd number of them: rows a power of two apart
  // would share few sets of the cache.
  static std::size_t strideOf(int samples) {
    return (static_cast<std::size_t>(samples) / 4 | 1) * 4 + 8;
  }

  void resize(int lines, int samples) {
    stride_ = strideOf(samples);
    const std::size_t size = static_cast<std::size_t>(lines) * stride_;
    if (sums_.size() != size) sums_.assign(size, {});
  }
  EchoSum* data() { return sums_.data(); }
  EchoSum* line(int i) { return sums_.data() + static_cast<std::size_t>(i) * stride_; }

 private:
  std::size_t stride_ = 0;
  std::vector<EchoSum> sums_;
};

// Echoes on their way to their samples. The sums are larger than the nearer caches: memory is asked
// for as an echo comes and is there when it is added.
class SplatQueue {
 public:
  // Takes echoes of these lines alone.
  explicit SplatQueue(LineRange lines)
      : first_line_(static_cast<float>(lines.first)), end_line_(static_cast<float>(lines.end)) {}
  Ints8 holds(Floats8 line) const { return (line >= first_line_) & (line < end_line_); }

  // Of lanes that are seen (-1, else 0). Every place is one of the sums.
  void add(const Floats4* numbers, Ints8 places, Ints8 seen, EchoSums& sums);
  void flush(EchoSums& sums);

 private:
  static constexpr std::size_t kMost = 256;
  float first_line_, end_line_;
  std::size_t count_ = 0;
  Floats4 numbers_[kMost];
  std::int32_t places_[kMost];
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
           const GaussianMix& mix, SplatQueue& queue, EchoSums& sums) const;

  // Eight scatterers at their own places, with the mix's numbers from `j` on.
  void addPlaces(const BeamCube& at, const GaussianMix& mix, std::uint32_t j, SplatQueue& queue,
                 EchoSums& sums) const;

 private:
  // Turns that the lens adds at the cut, over a cube's samples.
  struct Bend {
    float first, slope;
  };
  Bend bendOf(Floats8 sample) const;
  void addLanes(const BeamCube& at, const Bend& bend, const GaussianMix& mix, std::uint32_t j,
                SplatQueue& queue, EchoSums& sums) const;

  int samples_, stride_;
  float turns_per_sample_, turns_before_;
  double min_depth_m_, spacing_m_, lens_, focus_m_;
};

}  // namespace echocine
