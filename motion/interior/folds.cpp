#include "motion/interior/folds.h"

#include <algorithm>

#include "core/lanes.h"

namespace echocine {

namespace {

// A cell that keeps less than this part of its volume is about to fold: its surroundings are made
// this much stiffer. Our choices.
constexpr float kLeastVolume = 0.05f, kStiffer = 16;
// One that keeps this part is not looked at in later rounds, which change little there. Our choice.
constexpr float kSafeVolume = 0.5f;

// The instants at which cells are looked at, and the rows of each class that make them.
struct Instants {
  std::vector<std::vector<std::vector<KeyframeWeights::Term>>> terms;  // by instant and class

  Instants(std::span<const PhaseClass> classes, std::span<const double> phases) {
    for (const double phase : phases) {
      terms.emplace_back(classes.size());
      for (std::size_t c = 0; c < classes.size(); ++c)
        classes[c].weights.termsAt(phase, terms.back()[c]);
    }
  }
};

// The keyframes of all classes.
std::vector<double> keyframePhases(std::span<const PhaseClass> classes) {
  std::vector<double> phases;
  for (const PhaseClass& c : classes)
    phases.insert(phases.end(), c.weights.phases().begin(), c.weights.phases().end());
  std::sort(phases.begin(), phases.end());
  phases.erase(std::unique(phases.begin(), phases.end()), phases.end());
  return phases;
}

// Two instants between each keyframe and the next.
std::vector<double> phasesBetween(std::span<const double> keyframes) {
  std::vector<double> phases;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const double from = keyframes[k];
    const double to = k + 1 < keyframes.size() ? keyframes[k + 1] : keyframes[0] + 1;
    for (const double part : {1.0 / 3, 2.0 / 3}) phases.push_back(from + part * (to - from));
  }
  return phases;
}

// Vectors at the corners of a cell, or from corner to corner; lane i has corner i.
struct CellVectors {
  Floats8 x{}, y{}, z{};

  void add(float weight, const std::vector<Vec3f>& row, const std::uint32_t (&corners)[8]) {
    Floats8 dx{}, dy{}, dz{};
    for (std::size_t i = 0; i < kFloatLanes; ++i) {
      const Vec3f at = row[corners[i]];
      dx[i] = at.x;
      dy[i] = at.y;
      dz[i] = at.z;
    }
    x += weight * dx;
    y += weight * dy;
    z += weight * dz;
  }
  // Edges at each corner: from their low end to their high end.
  CellVectors alongX(float h) const {
    const auto edge = [](Floats8 d, float length) {
      return length + __builtin_shufflevector(d, d, 1, 1, 3, 3, 5, 5, 7, 7) -
             __builtin_shufflevector(d, d, 0, 0, 2, 2, 4, 4, 6, 6);
    };
    return {edge(x, h), edge(y, 0), edge(z, 0)};
  }
  CellVectors alongZ(float h) const {
    const auto edge = [](Floats8 d, float length) {
      return length + __builtin_shufflevector(d, d, 2, 3, 2, 3, 6, 7, 6, 7) -
             __builtin_shufflevector(d, d, 0, 1, 0, 1, 4, 5, 4, 5);
    };
    return {edge(x, 0), edge(y, 0), edge(z, h)};
  }
  CellVectors alongY(float h) const {
    const auto edge = [](Floats8 d, float length) {
      return length + __builtin_shufflevector(d, d, 4, 5, 6, 7, 4, 5, 6, 7) -
             __builtin_shufflevector(d, d, 0, 1, 2, 3, 0, 1, 2, 3);
    };
    return {edge(x, 0), edge(y, h), edge(z, 0)};
  }
};

// The least part of its volume that a corner of the cell keeps at any instant, all classes
// together; once it is about to fold, no less is looked for. Corner numbers have bit 0 for x, 1 for
// z, 2 for y.
float leastVolume(const GroupLattice& lattice, const Instants& instants,
                  const std::uint32_t (&corners)[8]) {
  const float h = lattice.grid.spacing_m;
  float least = 1;
  for (const auto& terms : instants.terms) {
    CellVectors d;
    for (std::size_t c = 0; c < terms.size(); ++c)
      for (const KeyframeWeights::Term& term : terms[c])
        d.add(static_cast<float>(term.weight), lattice.rows_m[c][term.row], corners);
    const CellVectors x = d.alongX(h), y = d.alongY(h), z = d.alongZ(h);
    const Floats8 volume = (x.x * (y.y * z.z - y.z * z.y) + x.y * (y.z * z.x - y.x * z.z) +
                            x.z * (y.x * z.y - y.y * z.x)) /
                           (h * h * h);
    for (std::size_t i = 0; i < kFloatLanes; ++i) least = std::min(least, volume[i]);
    if (least < kLeastVolume) return least;
  }
  return least;
}

}  // namespace

bool stiffenFolds(const GroupLattice& lattice, std::span<const PhaseClass> classes,
                  std::vector<bool>& used, std::span<float> stiffness) {
  const LatticeGrid& grid = lattice.grid;
  const std::vector<double> phases = keyframePhases(classes);
  const Instants at_keyframes(classes, phases), between(classes, phasesBetween(phases));
  std::vector<bool> stiffer(stiffness.size(), false);
  bool found = false;
  for (int y = 0; y + 1 < grid.ny; ++y)
    for (int z = 0; z + 1 < grid.nz; ++z)
      for (int x = 0; x + 1 < grid.nx; ++x) {
        std::uint32_t corners[8];
        bool whole = true;
        for (int i = 0; i < 8; ++i) {
          const std::int32_t n =
              lattice.nodes.numberAt(x + (i & 1), y + (i >> 2), z + (i >> 1 & 1));
          whole &= n >= 0;
          corners[i] = static_cast<std::uint32_t>(n);
        }
        if (!whole || !used[corners[0]]) continue;
        float least = leastVolume(lattice, at_keyframes, corners);
        if (least > kSafeVolume) used[corners[0]] = false;
        if (least > kLeastVolume && least <= kSafeVolume)
          least = std::min(least, leastVolume(lattice, between, corners));
        if (!(least < kLeastVolume)) continue;
        found = true;
        for (const std::uint32_t n : corners) stiffer[n] = true;
      }
  for (std::size_t n = 0; n < stiffer.size(); ++n)
    if (stiffer[n]) stiffness[n] *= kStiffer;
  return found;
}

}  // namespace echocine
