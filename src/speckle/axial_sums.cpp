#include "speckle/axial_sums.h"

#include <algorithm>

namespace echocine {

AxialSums::AxialSums(const SplatGrid& grid, int samples)
    : finer_(grid.along().finer), coarser_(grid.along().coarser) {
  range_ = tapRange(grid.along().nodes(grid.mostAxialSamples()), 0, 1 - 1.0 / coarser_);
  if (grid.axialSamples(0) != grid.mostAxialSamples()) pieces_ = (samples + kPiece - 1) / kPiece;
  for (int piece = 0; piece < pieces_; ++piece) {
    const int middle = std::min(piece * kPiece + kPiece / 2, samples - 1);
    addTaps(grid.along().nodes(grid.axialSamples(pieces_ == 1 ? 0 : middle)));
  }
}

void AxialSums::addTaps(double deviation) {
  std::vector<std::vector<double>> amplitudes, powers;
  for (int phase = 0; phase < coarser_; ++phase) {
    amplitudes.push_back(amplitudeTaps(deviation, static_cast<double>(phase) / coarser_, range_));
    powers.push_back(powerTaps(amplitudes.back(), range_));
  }
  for (std::size_t first = 0; first < amplitudes.size(); first += 2) {
    const std::size_t second = std::min(first + 1, amplitudes.size() - 1);
    for (std::size_t t = 0; t < static_cast<std::size_t>(range_.count); ++t) {
      const auto k1 = static_cast<float>(amplitudes[first][t]),
                 h1 = static_cast<float>(powers[first][t]),
                 k2 = static_cast<float>(amplitudes[second][t]),
                 h2 = static_cast<float>(powers[second][t]);
      taps_.push_back(Floats8{k1, k1, h1, h1, k2, k2, h2, h2});
    }
  }
}

template <typename Load>
void AxialSums::smearBy(const float* nodes, int samples, const Load& load, float* out) const {
  const int phases = std::max(coarser_ / 2, 1);
  static_assert(kPiece % (2 * kPairs) == 0);
  for (int k = 0; k < samples; k += 2 * kPairs) {
    const int piece = std::min(k / kPiece, pieces_ - 1);
    Floats8 sums[kPairs] = {};
    const float* from[kPairs];
    const Floats8* taps[kPairs];
    for (int p = 0; p < kPairs; ++p) {
      const int sample = k + 2 * p;
      from[p] = nodes + kNodeFloats * (sample * finer_ / coarser_ + range_.first);
      taps[p] = taps_.data() + (piece * phases + sample / 2 % phases) * range_.count;
    }
    for (int t = 0; t < range_.count; ++t)
      for (int p = 0; p < kPairs; ++p) sums[p] += taps[p][t] * load(from[p] + kNodeFloats * t);
    for (int p = 0; p < kPairs; ++p) store(sums[p], out + kNodeFloats * (k + 2 * p));
  }
}

void AxialSums::smear(const float* nodes, int samples, float* out) const {
  const auto joined = [](Floats4 a, Floats4 b) {
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
  };
  if (coarser_ > 1)
    smearBy(
        nodes, samples, [&](const float* at) { return joined(fourAt(at), fourAt(at)); }, out);
  else if (finer_ == 1)
    smearBy(
        nodes, samples, [](const float* at) { return lanesAt(at); }, out);
  else
    smearBy(
        nodes, samples,
        [&](const float* at) { return joined(fourAt(at), fourAt(at + kNodeFloats * finer_)); },
        out);
}

}  // namespace echocine
