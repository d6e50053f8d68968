#include "motion/interior/lattice_equations.h"

#include <algorithm>
#include <cstdlib>

#include "core/stop.h"

namespace echocine {

namespace {

// Holds what no sample reaches; far below any sample's weight.
constexpr double kRidge = 1e-6;

struct Offset {
  int x, y, z;
};

constexpr Offset operator-(Offset a, Offset b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

std::array<Offset, 33> stencilOffsets() {
  std::array<Offset, 33> offsets{};
  std::size_t n = 0;
  for (int y = -1; y <= 1; ++y)
    for (int z = -1; z <= 1; ++z)
      for (int x = -1; x <= 1; ++x) offsets[n++] = {x, y, z};
  for (const int s : {-2, 2})
    for (const Offset o : {Offset{s, 0, 0}, Offset{0, s, 0}, Offset{0, 0, s}}) offsets[n++] = o;
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
                                   std::span<const float> stiffness,
                                   std::span<const std::uint32_t> fixed)
    : nodes_(nodes), slots_(nodes.nodes.size()) {
  addSamples(samples);
  checkpoint();
  addBending(stiffness);
  checkpoint();
  for (auto& row : slots_) row[slotOf({0, 0, 0})] += kRidge;
  compress(fixed);
  slots_ = {};
}

LatticeEquations::Place LatticeEquations::placeOf(std::uint32_t number) const {
  const auto node = static_cast<int>(nodes_.nodes[number]);
  return {node % nodes_.nx, node / (nodes_.nx * nodes_.nz), node / nodes_.nx % nodes_.nz};
}

void LatticeEquations::addSamples(std::span<const LatticeSample> samples) {
  const Pattern<8> cell = cellPattern();
  for (const LatticeSample& sample : samples) {
    double factors[8];
    for (std::size_t i = 0; i < 8; ++i) factors[i] = sample.share[i];
    cell.addProduct(sample.node, factors, sample.weight, slots_);
  }
}

// |D^2 u|^2 = u_xx^2 + u_yy^2 + u_zz^2 + 2 (u_xy^2 + u_yz^2 + u_zx^2). A difference is left out
// where one of its nodes takes no part: no condition across the border of the region.
void LatticeEquations::addBending(std::span<const float> stiffness) {
  constexpr double kStraight[3] = {1, -2, 1}, kMixed[4] = {1, -1, -1, 1};
  const auto addAll = [&](const auto& pattern, const auto& factors, double times) {
    std::uint32_t numbers[std::extent_v<std::remove_reference_t<decltype(factors)>>];
    for (std::uint32_t n = 0; n < slots_.size(); ++n) {
      const Place at = placeOf(n);
      bool whole = true;
      for (std::size_t i = 0; i < pattern.offsets.size(); ++i) {
        const Offset o = pattern.offsets[i];
        const std::int32_t number = nodes_.numberAt(at.x + o.x, at.y + o.y, at.z + o.z);
        whole &= number >= 0;
        numbers[i] = static_cast<std::uint32_t>(number);
      }
      if (whole)
        pattern.addProduct(numbers, factors, times * static_cast<double>(stiffness[n]), slots_);
    }
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Offset a = kAxes[i], b = kAxes[(i + 1) % 3];
    addAll(Pattern<3>({Offset{-a.x, -a.y, -a.z}, {0, 0, 0}, a}), kStraight, 1);
    addAll(Pattern<4>({Offset{0, 0, 0}, a, b, {a.x + b.x, a.y + b.y, a.z + b.z}}), kMixed, 2);
  }
}

// To lists of neighbours that matter. A fixed node's row and column become those of u = 0.
void LatticeEquations::compress(std::span<const std::uint32_t> fixed) {
  std::vector<bool> held(slots_.size(), false);
  for (const std::uint32_t n : fixed) held[n] = true;
  const auto offsets = stencilOffsets();
  starts_.push_back(0);
  for (std::uint32_t n = 0; n < slots_.size(); ++n) {
    const Place at = placeOf(n);
    for (std::size_t s = 0; s < offsets.size(); ++s) {
      if (slots_[n][s] == 0) continue;
      const auto other = static_cast<std::uint32_t>(
          nodes_.numberAt(at.x + offsets[s].x, at.y + offsets[s].y, at.z + offsets[s].z));
      if (other != n && (held[n] || held[other])) continue;
      members_.push_back(other);
      values_.push_back(static_cast<float>(slots_[n][s]));
    }
    inverse_diagonal_.push_back(1 / static_cast<float>(slots_[n][slotOf({0, 0, 0})]));
    starts_.push_back(static_cast<std::uint32_t>(members_.size()));
  }
}

}  // namespace echocine
