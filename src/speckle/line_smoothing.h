#pragma once
// A Gaussian filter along a line, at bounded cost per sample for any width.

#include <vector>

namespace echocine {

class LineSmoothing {
 public:
  LineSmoothing(int samples, double deviation_samples);

  // Floats required before the first sample of a line and behind its last one.
  int margin() const { return margin_; }

  // Floats that apply() writes to `out`: the samples, rounded up to whole groups of lanes.
  int length() const;

  // Samples from `line` to `out`. The margins are overwritten: ends are mirrored, so that the mean
  // stays. coarse: memory of a line in the making.
  void apply(float* line, std::vector<float>& coarse, float* out) const;

 private:
  void smear(const float* from, int count, float* to) const;
  void throughBlocks(const float* line, std::vector<float>& coarse, float* out) const;

  int samples_, block_, margin_;
  std::vector<float> taps_;  // of distance 0, 1, ... blocks; they sum to 1
};

}  // namespace echocine
