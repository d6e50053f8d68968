// Equations of a lattice after a change of some nodes' stiffness: computed in part, they are those
// computed anew, to the last bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/hash_random.h"
#include "motion/interior/lattice_equations.h"
#include "motion/interior/multigrid.h"

namespace echocine {
namespace {

constexpr int kBedSide = 14;

// A box of nodes with a round hole, samples all over it, and a few nodes that are held.
struct LatticeBed {
  ActiveNodes nodes{kBedSide, kBedSide, kBedSide, {}, {}};
  std::vector<LatticeSample> samples;
  std::vector<float> stiffness;
  std::vector<bool> own;
  std::vector<std::uint32_t> fixed;

  LatticeBed() {
    for (int y = 0; y < kBedSide; ++y)
      for (int z = 0; z < kBedSide; ++z)
        for (int x = 0; x < kBedSide; ++x) {
          const bool hole = std::hypot(x - 4, y - 9, z - 5) < 2.5;
          nodes.number.push_back(hole ? -1 : static_cast<std::int32_t>(nodes.nodes.size()));
          if (!hole) nodes.nodes.push_back(static_cast<std::uint32_t>(nodes.at(x, y, z)));
        }
    for (std::uint64_t s = 0; s < 900; ++s) addSample(s);
    for (std::uint32_t n = 0; n < nodes.nodes.size(); ++n) {
      own.push_back(uniformFromHash(hashOf(n, 1)) < 0.8);
      if (n % 97 == 0) fixed.push_back(n);
    }
    stiffness.assign(nodes.nodes.size(), 1);
  }

  void addSample(std::uint64_t s) {
    const auto at = [&](int axis) { return (kBedSide - 1) * uniformFromHash(hashOf(s, axis, 2)); };
    const double place[3] = {at(0), at(1), at(2)};
    LatticeSample sample{};
    for (int corner = 0; corner < 8; ++corner) {
      const int bits[3] = {corner & 1, corner >> 2, corner >> 1 & 1};
      int node[3];
      double share = 1;
      for (int axis = 0; axis < 3; ++axis) {
        const int low = std::min(static_cast<int>(place[axis]), kBedSide - 2);
        node[axis] = low + bits[axis];
        share *= bits[axis] ? place[axis] - low : 1 - (place[axis] - low);
      }
      const std::int32_t number = nodes.numberAt(node[0], node[1], node[2]);
      if (number < 0) return;
      sample.node[corner] = static_cast<std::uint32_t>(number);
      sample.share[corner] = static_cast<float>(share);
    }
    sample.weight = static_cast<float>(uniformFromHash(hashOf(s, 3)));
    samples.push_back(sample);
  }

  // Stiffer within some nodes of a node.
  std::vector<float> stiffer(std::uint32_t about, double radius) const {
    std::vector<float> changed = stiffness;
    const auto place = [&](std::uint32_t n) {
      const auto node = static_cast<int>(nodes.nodes[n]);
      return Vec3d{static_cast<double>(node % kBedSide),
                   static_cast<double>(node / (kBedSide * kBedSide)),
                   static_cast<double>(node / kBedSide % kBedSide)};
    };
    for (std::uint32_t n = 0; n < changed.size(); ++n)
      if (length(place(n) - place(about)) <= radius) changed[n] *= 4;
    return changed;
  }
};

template <typename Number>
void expectSameLatticeRows(const SparseRows<Number>& a, const SparseRows<Number>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    ASSERT_TRUE(std::ranges::equal(a[n].members, b[n].members)) << n;
    ASSERT_TRUE(std::ranges::equal(a[n].values, b[n].values)) << n;
  }
}

TEST(LatticeUpdateLaw, RowsAndCoarseRowsAreThoseOfNewEquations) {
  const LatticeBed bed;
  const LatticeEquations before(bed.nodes, bed.samples, bed.stiffness, bed.own, bed.fixed);
  const Multigrid grid(bed.nodes, before.rows());
  for (const auto& [about, radius] : {std::pair(0u, 0.5), {700u, 0.0}, {1300u, 2.0}, {90u, 30.0}}) {
    const std::vector<float> stiffness = bed.stiffer(about, radius);
    std::vector<bool> changed(stiffness.size());
    for (std::size_t n = 0; n < changed.size(); ++n) changed[n] = stiffness[n] != bed.stiffness[n];
    const LatticeEquations anew(bed.nodes, bed.samples, stiffness, bed.own, bed.fixed),
        updated(bed.nodes, bed.samples, stiffness, bed.own, bed.fixed, before, changed);
    expectSameLatticeRows(updated.rows(), anew.rows());
    const Multigrid grid_anew(bed.nodes, anew.rows()),
        grid_updated(bed.nodes, updated.rows(), &grid, changed);
    ASSERT_EQ(grid_updated.levels().size(), 3u);
    ASSERT_EQ(grid_anew.levels().size(), 3u);
    for (std::size_t l = 0; l < 3; ++l) {
      expectSameLatticeRows(grid_updated.levels()[l].rows, grid_anew.levels()[l].rows);
      expectSameLatticeRows(grid_updated.levels()[l].parents, grid_anew.levels()[l].parents);
      EXPECT_EQ(grid_updated.levels()[l].inverse_diagonal, grid_anew.levels()[l].inverse_diagonal);
    }
    EXPECT_TRUE(std::ranges::equal(grid_updated.lastFactor(), grid_anew.lastFactor()));
  }
}

// A change that reaches the rows is one that the test could miss.
TEST(LatticeUpdateLaw, AChangeOfStiffnessChangesTheRowsAboutIt) {
  const LatticeBed bed;
  const LatticeEquations before(bed.nodes, bed.samples, bed.stiffness, bed.own, bed.fixed);
  const std::vector<float> stiffness = bed.stiffer(1300, 0);
  std::vector<bool> changed(stiffness.size());
  changed[1300] = true;
  const LatticeEquations updated(bed.nodes, bed.samples, stiffness, bed.own, bed.fixed, before,
                                 changed);
  std::size_t differing = 0;
  for (std::size_t n = 0; n < stiffness.size(); ++n) {
    const bool differs = !std::ranges::equal(updated.rows()[n].values, before.rows()[n].values);
    differing += differs;
    EXPECT_FALSE(differs && !changed[n]) << n;
  }
  EXPECT_GT(differing, 6u);
  EXPECT_LE(differing, 27u);
}

// Weights of samples that differ make all rows anew; so does LatticeFit.
TEST(LatticeUpdateLaw, AFitAfterUpdatesIsTheFitOfNewEquations) {
  LatticeBed bed;
  std::vector<float> data;
  for (std::size_t i = 0; i < 5 * bed.samples.size(); ++i)
    data.push_back(static_cast<float>(uniformFromHash(hashOf(i, 4)) - 0.5));
  LatticeFit fit(bed.nodes, bed.samples, bed.stiffness, bed.own, bed.fixed);
  for (LatticeSample& sample : bed.samples) sample.weight *= 0.5f;
  fit.update(bed.stiffness);
  bed.stiffness = bed.stiffer(1300, 2);
  fit.update(bed.stiffness);
  bed.stiffness = bed.stiffer(400, 1);
  fit.update(bed.stiffness);
  const LatticeFit anew(bed.nodes, bed.samples, bed.stiffness, bed.own, bed.fixed);
  EXPECT_EQ(fit.solve(data, 5, {}, 1e-6).values, anew.solve(data, 5, {}, 1e-6).values);
}

}  // namespace
}  // namespace echocine
