#pragma once
// Sums along a line: from the nodes of the grid to the line's samples.

#include <vector>

#include "core/lanes.h"
#include "speckle/splat_grid.h"

namespace echocine {

// g and w of eight samples.
struct EightSums {
  Floats8 real, imaginary, power;
};

class AxialSums {
 public:
  AxialSums(const SplatGrid& grid, double deviation_samples);

  // take(sums, k) for each eight samples from k on. nodes: sums of the rows, with the grid's margin
  // of zeros about them.
  template <typename Take>
  void each(const float* nodes, int samples, const Take& take) const;

 private:
  static constexpr int kPairs = 4;
  template <typename Load, typename Take>
  void eachBy(const float* nodes, int samples, const Load& load, const Take& take) const;

  int finer_, coarser_;
  TapRange range_;
  // By pair of samples between two nodes: k, k, H, H of the first and of the second sample.
  std::vector<Floats8> taps_;
};

// In the order of samples. Each of the four has two: real, imaginary, P, Q, and again.
inline EightSums sorted(const Floats8 (&pairs)[4]) {
  const auto low = [](Floats8 a, Floats8 b) {
    return __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
  };
  const auto high = [](Floats8 a, Floats8 b) {
    return __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
  };
  // Samples 0 2 4 6 1 3 5 7.
  const Floats8 fields = low(pairs[0], pairs[1]), fields_on = low(pairs[2], pairs[3]);
  const Floats8 powers = high(pairs[0], pairs[1]), powers_on = high(pairs[2], pairs[3]);
  const auto firsts = [](Floats8 a, Floats8 b) {
    return __builtin_shufflevector(a, b, 0, 4, 1, 5, 8, 12, 9, 13);
  };
  const auto seconds = [](Floats8 a, Floats8 b) {
    return __builtin_shufflevector(a, b, 2, 6, 3, 7, 10, 14, 11, 15);
  };
  return {firsts(fields, fields_on), seconds(fields, fields_on),
          firsts(powers, powers_on) + seconds(powers, powers_on)};
}

template <typename Load, typename Take>
void AxialSums::eachBy(const float* nodes, int samples, const Load& load, const Take& take) const {
  const int phases = std::max(coarser_ / 2, 1);
  for (int k = 0; k < samples; k += 2 * kPairs) {
    Floats8 sums[kPairs] = {};
    const float* from[kPairs];
    const Floats8* taps[kPairs];
    for (int p = 0; p < kPairs; ++p) {
      const int sample = k + 2 * p;
      from[p] = nodes + kNodeFloats * (sample * finer_ / coarser_ + range_.first);
      taps[p] = taps_.data() + sample / 2 % phases * range_.count;
    }
    for (int t = 0; t < range_.count; ++t)
      for (int p = 0; p < kPairs; ++p) sums[p] += taps[p][t] * load(from[p] + kNodeFloats * t);
    take(sorted(sums), k);
  }
}

template <typename Take>
void AxialSums::each(const float* nodes, int samples, const Take& take) const {
  const auto joined = [](Floats4 a, Floats4 b) {
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
  };
  if (coarser_ > 1)
    eachBy(
        nodes, samples, [&](const float* at) { return joined(fourAt(at), fourAt(at)); }, take);
  else if (finer_ == 1)
    eachBy(
        nodes, samples, [](const float* at) { return lanesAt(at); }, take);
  else
    eachBy(
        nodes, samples,
        [&](const float* at) { return joined(fourAt(at), fourAt(at + kNodeFloats * finer_)); },
        take);
}

}  // namespace echocine
