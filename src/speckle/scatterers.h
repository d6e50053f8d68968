#pragma once
// The scatterers of a scene: places in the reference phase, drawn once, the same for any frame,
// order and thread. A scatterer is complex Gaussian (a small crowd, not a point), so that the sum
// is Rayleigh at any density.

#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "speckle/beam_view.h"
#include "speckle/material.h"

namespace echocine {

// Scatterers of one group in one cube, at most kMostOfBatch.
struct ScattererBatch {
  Vec3f low_m;
  float edge_m = 0;
  std::uint32_t first = 0, count = 0;  // first is a multiple of the lanes
  std::uint16_t group = 0;
  bool blood = false;
  std::uint64_t pattern = 0;  // what its Gaussian numbers are drawn by
};

inline constexpr std::uint32_t kMostOfBatch = 1024;

// Complex numbers with zero mean and variance 1, any run of which serves as a batch's.
class GaussianTable {
 public:
  explicit GaussianTable(int seed);
  static constexpr std::uint32_t kStarts = 8192;
  const float* real(std::uint64_t start) const { return real_.data() + start % kStarts; }
  const float* imaginary(std::uint64_t start) const { return imaginary_.data() + start % kStarts; }

 private:
  std::vector<float> real_, imaginary_;
};

class Scatterers {
 public:
  // Throws SceneError when they would not fit into memory.
  Scatterers(const Probe& probe, const PointSpread& spread, const BeamView& view,
             const SpeckleSettings& settings, const Material& material);

  const std::vector<ScattererBatch>& batches() const { return batches_; }
  std::size_t count() const { return count_; }
  // Places in their cubes, 0 to 1; NaN between the end of a batch and the next whole lanes.
  const float* u(const ScattererBatch& b) const { return u_.data() + b.first; }
  const float* v(const ScattererBatch& b) const { return v_.data() + b.first; }
  const float* w(const ScattererBatch& b) const { return w_.data() + b.first; }

  // Factors of amplitude; none where all are 1.
  const float* strength(const ScattererBatch& b) const {
    return strength_.empty() ? nullptr : strength_.data() + b.first;
  }

 private:
  struct Block;
  void weigh(const Material& material);
  void addBlock(const Block& block, const Material& material);
  void dropUnseen(const BeamView& view, const Material& material);
  void addBatch(std::span<const Vec3f> places_m, Vec3f low_m, float edge_m, std::uint16_t group,
                bool blood, std::uint64_t pattern);

  std::vector<ScattererBatch> batches_;
  std::vector<float> u_, v_, w_, strength_;
  std::size_t count_ = 0;
};

}  // namespace echocine
