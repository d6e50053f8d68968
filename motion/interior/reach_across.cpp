#include "motion/interior/reach_across.h"

#include <algorithm>
#include <vector>

namespace echocine {

double reachAcross(const GroupLattice& lattice, std::span<const PhaseClass> classes) {
  std::vector<double> most_m;  // by active node, the sum over classes
  for (std::size_t c = 0; c < lattice.rows_m.size(); ++c) {
    const KeyframeWeights& weights = classes[c].weights;
    const auto& rows = lattice.rows_m[c];
    if (rows.empty()) continue;
    const std::span keyframes = std::span(rows).first(weights.keyframeCount());
    const double beyond = weights.overshoot();
    most_m.resize(rows.front().size());
    for (std::size_t i = 0; i < most_m.size(); ++i) {
      const auto y = [i](const std::vector<Vec3f>& row) { return double{row[i].y}; };
      const auto [low, high] = std::ranges::minmax_element(keyframes, {}, y);
      const double low_m = y(*low), high_m = y(*high);
      most_m[i] += std::max(-low_m, high_m) + beyond * (high_m - low_m);
    }
  }
  return most_m.empty() ? 0 : *std::max_element(most_m.begin(), most_m.end());
}

}  // namespace echocine
