#include "motion/interior/lattice_equations.h"

#include <algorithm>
#include <cstdlib>

#include "core/stop.h"

namespace echocine {

namespace {

// Holds nodes that no sample reaches. It is far below the bending of the smoothest field, whose
// energy per node falls with the fourth power of the nodes across: 1e-6 for 30 of them.
constexpr double kRidge = 1e-10;
// Weights of the Laplacian and of second differences, relative to a cell's samples. Our choices:
// the field is harmonic inside the group's own tissue. Second differences extend it outside and
// through walls thinner than a cell. Inside they have a tenth of the weight, which keeps the error
// of an inflating ball at 0.02 mm.
constexpr double kLaplacian = 1e-2, kBending = 1e-3;

struct Offset {
  int x, y, z;
};

constexpr Offset operator-(Offset a, Offset b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

// In the order of the nodes' numbers.
std::array<Offset, 33> stencilOffsets() {
  std::array<Offset, 33> offsets{};
  std::size_t n = 0;
  for (int y = -2; y <= 2; ++y)
    for (int z = -2; z <= 2; ++z)
      for (int x = -2; x <= 2; ++x) {
        const int most = std::max({std::abs(x), std::abs(y), std::abs(z)});
        if (most <= 1 || std::abs(x) + std::abs(y) + std::abs(z) == 2) offsets[n++] = {x, y, z};
      }
  return offsets;
}

// Where in the stencil an offset stands.
std::size_t slotOf(Offset o) {
  if (std::max({std::abs(o.x), std::abs(o.y), std::abs(o.z)}) <= 1)
    return static_cast<std::size_t>((o.y + 1) * 9 + (o.z + 1) * 3 + o.x + 1);
  const std::size_t sign = o.x + o.y + o.z > 0 ? 3 : 0;
  return 27 + sign + (o.x != 0 ? 0u : o.y != 0 ? 1u : 2u);
}

// Nodes that stand together in one term of the sum, from the first; and which slot of one's row
// another has.
template <std::size_t kCount>
struct Pattern {
  std::array<Offset, kCount> offsets;
  std::size_t slots[kCount][kCount];

  explicit Pattern(const std::array<Offset, kCount>& nodes) : offsets(nodes) {
    for (std::size_t a = 0; a < kCount; ++a)
      for (std::size_t b = 0; b < kCount; ++b) slots[a][b] = slotOf(nodes[b] - nodes[a]);
  }

  // Adds weight * f f^T for a combination f of the nodes.
  template <typename Rows>
  void addProduct(const std::uint32_t (&numbers)[kCount], const double (&factors)[kCount],
                  double weight, Rows& rows) const {
    for (std::size_t a = 0; a < kCount; ++a)
      for (std::size_t b = 0; b < kCount; ++b)
        rows[numbers[a]][slots[a][b]] += weight * factors[a] * factors[b];
  }
};

// Corners of a cell, as in LatticeSample.
Pattern<8> cellPattern() {
  std::array<Offset, 8> corners{};
  for (int i = 0; i < 8; ++i) corners[static_cast<std::size_t>(i)] = {i & 1, i >> 2, i >> 1 & 1};
  return Pattern<8>(corners);
}

constexpr Offset kAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

}  // namespace

LatticeEquations::LatticeEquations(const ActiveNodes& nodes, std::span<const LatticeSample> samples,
                                   std::span<const float> stiffness, const std::vector<bool>& own,
                                   std::span<const std::uint32_t> fixed)
    : nodes_(nodes),
      wanted_(nodes.nodes.size(), true),
      entering_(wanted_),
      slots_(nodes.nodes.size()) {
  addAll(samples, stiffness, own);
  compress(fixed, nullptr);
}

// A term's nodes are neighbours, along axes and diagonals. So a node's stiffness enters the rows
// about it, and terms of the nodes about a row enter that row. Each row is the sum of the same
// terms in the same order.
LatticeEquations::LatticeEquations(const ActiveNodes& nodes, std::span<const LatticeSample> samples,
                                   std::span<const float> stiffness, const std::vector<bool>& own,
                                   std::span<const std::uint32_t> fixed,
                                   const LatticeEquations& earlier, std::vector<bool>& changed)
    : nodes_(nodes),
      wanted_(about(changed)),
      entering_(about(wanted_)),
      slots_(nodes.nodes.size()) {
  changed = wanted_;
  addAll(samples, stiffness, own);
  compress(fixed, &earlier);
}

void LatticeEquations::addAll(std::span<const LatticeSample> samples,
                              std::span<const float> stiffness, const std::vector<bool>& own) {
  addSamples(samples);
  checkpoint();
  addLaplacians(stiffness, own);
  checkpoint();
  addBending(stiffness);
  checkpoint();
  for (auto& row : slots_) row[slotOf({0, 0, 0})] += kRidge;
}

// These nodes and their 26 neighbours.
std::vector<bool> LatticeEquations::about(const std::vector<bool>& some) const {
  std::vector<bool> near(some.size(), false);
  for (std::uint32_t n = 0; n < some.size(); ++n) {
    if (!some[n]) continue;
    const Place at = placeOf(n);
    for (int y = at.y - 1; y <= at.y + 1; ++y)
      for (int z = at.z - 1; z <= at.z + 1; ++z)
        for (int x = at.x - 1; x <= at.x + 1; ++x)
          if (const std::int32_t number = nodes_.numberAt(x, y, z); number >= 0)
            near[static_cast<std::size_t>(number)] = true;
  }
  return near;
}

LatticeEquations::Place LatticeEquations::placeOf(std::uint32_t number) const {
  const auto node = static_cast<int>(nodes_.nodes[number]);
  return {node % nodes_.nx, node / (nodes_.nx * nodes_.nz), node / nodes_.nx % nodes_.nz};
}

void LatticeEquations::addSamples(std::span<const LatticeSample> samples) {
  const Pattern<8> cell = cellPattern();
  for (const LatticeSample& sample : samples) {
    if (std::ranges::none_of(sample.node, [&](std::uint32_t n) { return wanted_[n]; })) continue;
    double factors[8];
    for (std::size_t i = 0; i < 8; ++i) factors[i] = sample.share[i];
    cell.addProduct(sample.node, factors, sample.weight, slots_);
  }
}

// (Laplacian of u)^2 at the nodes of the body.
void LatticeEquations::addLaplacians(std::span<const float> stiffness,
                                     const std::vector<bool>& own) {
  const Pattern<7> cross(
      {Offset{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
  constexpr double kFactors[7] = {-6, 1, 1, 1, 1, 1, 1};
  for (std::uint32_t n = 0; n < slots_.size(); ++n) {
    if (!own[n] || !entering_[n]) continue;
    const Place at = placeOf(n);
    std::uint32_t numbers[7];
    bool whole = true;
    for (std::size_t c = 0; c < 7; ++c) {
      const Offset o = cross.offsets[c];
      const std::int32_t number = nodes_.numberAt(at.x + o.x, at.y + o.y, at.z + o.z);
      whole &= number >= 0;
      numbers[c] = static_cast<std::uint32_t>(number);
    }
    if (whole)
      cross.addProduct(numbers, kFactors, kLaplacian * static_cast<double>(stiffness[n]), slots_);
  }
}

// |D^2 u|^2 = u_xx^2 + u_yy^2 + u_zz^2 + 2 (u_xy^2 + u_yz^2 + u_zx^2). A difference is left out
// where one of its nodes takes no part: no condition across the border of the region.
void LatticeEquations::addBending(std::span<const float> stiffness) {
  constexpr double kStraight[3] = {1, -2, 1}, kMixed[4] = {1, -1, -1, 1};
  const auto addAll = [&](const auto& pattern, const auto& factors, double times) {
    std::uint32_t numbers[std::extent_v<std::remove_reference_t<decltype(factors)>>];
    for (std::uint32_t n = 0; n < slots_.size(); ++n) {
      if (!entering_[n]) continue;
      const Place at = placeOf(n);
      bool whole = true;
      for (std::size_t i = 0; i < pattern.offsets.size(); ++i) {
        const Offset o = pattern.offsets[i];
        const std::int32_t number = nodes_.numberAt(at.x + o.x, at.y + o.y, at.z + o.z);
        whole &= number >= 0;
        numbers[i] = static_cast<std::uint32_t>(number);
      }
      if (whole)
        pattern.addProduct(numbers, factors, kBending * times * static_cast<double>(stiffness[n]),
                           slots_);
    }
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Offset a = kAxes[i], b = kAxes[(i + 1) % 3];
    addAll(Pattern<3>({Offset{-a.x, -a.y, -a.z}, {0, 0, 0}, a}), kStraight, 1);
    addAll(Pattern<4>({Offset{0, 0, 0}, a, b, {a.x + b.x, a.y + b.y, a.z + b.z}}), kMixed, 2);
  }
}

// To lists of neighbours that matter. A fixed node's row and column become those of u = 0.
void LatticeEquations::compress(std::span<const std::uint32_t> fixed,
                                const LatticeEquations* earlier) {
  std::vector<bool> held(slots_.size(), false);
  for (const std::uint32_t n : fixed) held[n] = true;
  const auto offsets = stencilOffsets();
  rows_.reserve(slots_.size(), slots_.size() * kSlots);
  for (std::uint32_t n = 0; n < slots_.size(); ++n) {
    if (!wanted_[n]) {
      rows_.add(earlier->rows()[n]);
      continue;
    }
    const Place at = placeOf(n);
    for (const Offset o : offsets) {
      const double value = slots_[n][slotOf(o)];
      if (value == 0) continue;
      const auto other =
          static_cast<std::uint32_t>(nodes_.numberAt(at.x + o.x, at.y + o.y, at.z + o.z));
      if (other == n || !(held[n] || held[other])) rows_.add(other, value);
    }
    rows_.endRow();
  }
  slots_ = {};
  wanted_ = entering_ = {};
}

}  // namespace echocine
