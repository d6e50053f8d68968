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
  float surroundings = 0;     // Material::surroundings()
  std::uint64_t pattern = 0;  // what its Gaussian numbers are drawn by
};

inline constexpr std::uint32_t kMostOfBatch = 1024;

// Places of eight scatterers in their cube, 0 to kCubeEdge: a frame reads most of them, so they are
// short. A step is 0.2 um of 10 mm.
struct EightPlaces {
  std::uint16_t u[kFloatLanes], v[kFloatLanes], w[kFloatLanes];
};
inline constexpr std::uint16_t kCubeEdge = 65535;

// Complex numbers with zero mean and variance 1. A batch uses any run of them.
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
  // Places of a batch, which ascend in v. The last eight may be less: the rest are 0.
  const EightPlaces* places(const ScattererBatch& b) const { return places_.data() + eightOf(b); }
  // The highest v of each eight.
  const std::uint16_t* highest(const ScattererBatch& b) const {
    return highest_.data() + eightOf(b);
  }

  // Numbers within a batch: all scatterers between v = first and v = last lie in
  // [firstOf(first), endOf(last)).
  std::uint32_t firstOf(const ScattererBatch& b, float v) const;
  std::uint32_t endOf(const ScattererBatch& b, float v) const;

  // Factors of amplitude; none where all are 1. Also 1 for scatterers that no beam reaches.
  const float* strength(const ScattererBatch& b) const {
    return strength_.empty() ? nullptr : strength_.data() + b.first;
  }

 private:
  struct Drawn;
  static std::size_t eightOf(const ScattererBatch& b) { return b.first / kFloatLanes; }
  static std::size_t eightsOf(const ScattererBatch& b) {
    return (b.count + kFloatLanes - 1) / kFloatLanes;
  }
  void weigh(const Material& material, const BeamView& view);
  void take(Drawn& drawn);

  std::vector<ScattererBatch> batches_;
  std::vector<EightPlaces> places_;
  std::vector<std::uint16_t> highest_;
  std::vector<float> strength_;
  std::size_t count_ = 0;
};

}  // namespace echocine
