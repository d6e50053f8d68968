#include "motion/interior/lattice_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "core/stop.h"

namespace echocine {

namespace {

// Our choice: the residual falls to this part of the right-hand side, which leaves micrometres.
constexpr double kTolerance = 1e-4;
// Holds what no sample reaches; far below any sample's weight.
constexpr double kRidge = 1e-6;

// Second differences and trilinear samples couple a node with the 27 about it and with those two
// steps along an axis.
struct Offset {
  int x, y, z;
};

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
std::size_t slotOf(int x, int y, int z) {
  if (std::max({std::abs(x), std::abs(y), std::abs(z)}) <= 1)
    return static_cast<std::size_t>((y + 1) * 9 + (z + 1) * 3 + x + 1);
  const std::size_t sign = x + y + z > 0 ? 3 : 0;
  return 27 + sign + (x != 0 ? 0u : y != 0 ? 1u : 2u);
}

// The normal equations: a stencil per node.
class Equations {
 public:
  Equations(const ActiveNodes& nodes, std::span<const LatticeSample> samples,
            std::span<const float> stiffness, std::span<const std::uint32_t> fixed);

  std::size_t size() const { return starts_.size() - 1; }
  const std::vector<float>& diagonal() const { return diagonal_; }

  // out = A x for all columns.
  void apply(const std::vector<float>& x, std::size_t columns, std::vector<float>& out) const;

 private:
  using Row = std::array<double, 33>;
  struct Place {
    int x, y, z;
  };
  Place placeOf(std::uint32_t number) const;
  void addProduct(std::span<const std::uint32_t> numbers, std::span<const double> factors,
                  double weight);
  void addSamples(std::span<const LatticeSample> samples);
  void addBending(std::span<const float> stiffness);
  void addDifference(Place at, std::span<const Offset> offsets, std::span<const double> factors,
                     double weight);
  void compress(std::span<const std::uint32_t> fixed);

  const ActiveNodes& nodes_;
  std::vector<Row> rows_;
  std::vector<std::uint32_t> starts_, members_;
  std::vector<float> values_, diagonal_;
};

Equations::Equations(const ActiveNodes& nodes, std::span<const LatticeSample> samples,
                     std::span<const float> stiffness, std::span<const std::uint32_t> fixed)
    : nodes_(nodes), rows_(nodes.nodes.size(), Row{}) {
  addSamples(samples);
  checkpoint();
  addBending(stiffness);
  checkpoint();
  for (Row& row : rows_) row[slotOf(0, 0, 0)] += kRidge;
  compress(fixed);
  rows_.clear();
  rows_.shrink_to_fit();
}

Equations::Place Equations::placeOf(std::uint32_t number) const {
  const auto node = static_cast<int>(nodes_.nodes[number]);
  return {node % nodes_.nx, node / (nodes_.nx * nodes_.nz), node / nodes_.nx % nodes_.nz};
}

// Adds weight * f f^T for a combination f of nodes.
void Equations::addProduct(std::span<const std::uint32_t> numbers, std::span<const double> factors,
                           double weight) {
  Place places[8];
  for (std::size_t a = 0; a < numbers.size(); ++a) places[a] = placeOf(numbers[a]);
  for (std::size_t a = 0; a < numbers.size(); ++a)
    for (std::size_t b = 0; b < numbers.size(); ++b)
      rows_[numbers[a]][slotOf(places[b].x - places[a].x, places[b].y - places[a].y,
                               places[b].z - places[a].z)] += weight * factors[a] * factors[b];
}

void Equations::addSamples(std::span<const LatticeSample> samples) {
  for (const LatticeSample& sample : samples) {
    double factors[8];
    for (std::size_t i = 0; i < 8; ++i) factors[i] = sample.share[i];
    addProduct(sample.node, factors, sample.weight);
  }
}

// Nothing where one of the nodes takes no part: no condition across the border of the region.
void Equations::addDifference(Place at, std::span<const Offset> offsets,
                              std::span<const double> factors, double weight) {
  std::uint32_t numbers[4];
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const std::int32_t number =
        nodes_.numberAt(at.x + offsets[i].x, at.y + offsets[i].y, at.z + offsets[i].z);
    if (number < 0) return;
    numbers[i] = static_cast<std::uint32_t>(number);
  }
  addProduct(std::span(numbers, offsets.size()), factors, weight);
}

// |D^2 u|^2 = u_xx^2 + u_yy^2 + u_zz^2 + 2 (u_xy^2 + u_yz^2 + u_zx^2).
void Equations::addBending(std::span<const float> stiffness) {
  constexpr Offset kAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  constexpr double kStraight[3] = {1, -2, 1}, kMixed[4] = {1, -1, -1, 1};
  for (std::uint32_t n = 0; n < rows_.size(); ++n) {
    const Place at = placeOf(n);
    for (std::size_t i = 0; i < 3; ++i) {
      const Offset a = kAxes[i], b = kAxes[(i + 1) % 3];
      const Offset straight[3] = {{-a.x, -a.y, -a.z}, {0, 0, 0}, a};
      addDifference(at, straight, kStraight, stiffness[n]);
      const Offset mixed[4] = {{0, 0, 0}, a, b, {a.x + b.x, a.y + b.y, a.z + b.z}};
      addDifference(at, mixed, kMixed, 2 * stiffness[n]);
    }
  }
}

// To lists of neighbours that matter. A fixed node's row and column become those of u = 0.
void Equations::compress(std::span<const std::uint32_t> fixed) {
  std::vector<bool> held(rows_.size(), false);
  for (const std::uint32_t n : fixed) held[n] = true;
  const auto offsets = stencilOffsets();
  starts_.push_back(0);
  for (std::uint32_t n = 0; n < rows_.size(); ++n) {
    const Place at = placeOf(n);
    for (std::size_t s = 0; s < offsets.size(); ++s) {
      if (rows_[n][s] == 0) continue;
      const auto other = static_cast<std::uint32_t>(
          nodes_.numberAt(at.x + offsets[s].x, at.y + offsets[s].y, at.z + offsets[s].z));
      if (other != n && (held[n] || held[other])) continue;
      members_.push_back(other);
      values_.push_back(static_cast<float>(rows_[n][s]));
    }
    diagonal_.push_back(static_cast<float>(rows_[n][slotOf(0, 0, 0)]));
    starts_.push_back(static_cast<std::uint32_t>(members_.size()));
  }
}

void Equations::apply(const std::vector<float>& x, std::size_t columns,
                      std::vector<float>& out) const {
  for (std::size_t n = 0; n < size(); ++n) {
    float* const to = &out[n * columns];
    std::fill(to, to + columns, 0.0f);
    for (std::uint32_t m = starts_[n]; m < starts_[n + 1]; ++m) {
      const float value = values_[m];
      const float* const from = &x[members_[m] * columns];
      for (std::size_t c = 0; c < columns; ++c) to[c] += value * from[c];
    }
  }
}

using Sums = std::vector<double>;  // one per column

Sums dots(const std::vector<float>& a, const std::vector<float>& b, std::size_t columns) {
  Sums sums(columns, 0.0);
  for (std::size_t i = 0; i < a.size(); i += columns)
    for (std::size_t c = 0; c < columns; ++c)
      sums[c] += static_cast<double>(a[i + c]) * static_cast<double>(b[i + c]);
  return sums;
}

// Conjugate gradients with the diagonal as preconditioner, every column with its own steps.
class Solver {
 public:
  Solver(const Equations& equations, std::vector<float> right_side, std::vector<float> start,
         std::size_t columns)
      : equations_(equations), columns_(columns), x_(std::move(start)), r_(std::move(right_side)) {
    z_.resize(r_.size());
    product_.resize(r_.size());
    precondition();
    for (const double rho : dots(r_, z_, columns_))
      target_.push_back(kTolerance * kTolerance * rho);
    if (x_.empty()) {
      x_.assign(r_.size(), 0.0f);
    } else {
      equations_.apply(x_, columns_, product_);
      for (std::size_t i = 0; i < r_.size(); ++i) r_[i] -= product_[i];
      precondition();
    }
    p_ = z_;
    rho_ = dots(r_, z_, columns_);
  }

  std::vector<float> solve(int steps) {
    for (int i = 0; i < steps && !settled(); ++i) step();
    return std::move(x_);
  }

 private:
  bool settled() const {
    for (std::size_t c = 0; c < columns_; ++c)
      if (rho_[c] > target_[c]) return false;
    return true;
  }

  void precondition() {
    const std::vector<float>& diagonal = equations_.diagonal();
    for (std::size_t n = 0; n < diagonal.size(); ++n)
      for (std::size_t c = 0; c < columns_; ++c)
        z_[n * columns_ + c] = r_[n * columns_ + c] / diagonal[n];
  }

  // to += factor[c] * from
  void add(const std::vector<float>& factor, const std::vector<float>& from,
           std::vector<float>& to) const {
    for (std::size_t i = 0; i < to.size(); i += columns_)
      for (std::size_t c = 0; c < columns_; ++c) to[i + c] += factor[c] * from[i + c];
  }

  void step() {
    checkpoint();
    equations_.apply(p_, columns_, product_);
    const Sums curvature = dots(p_, product_, columns_);
    std::vector<float> alpha(columns_), minus(columns_), beta(columns_);
    for (std::size_t c = 0; c < columns_; ++c) {
      const bool done = rho_[c] <= target_[c] || curvature[c] <= 0;
      alpha[c] = done ? 0.0f : static_cast<float>(rho_[c] / curvature[c]);
      minus[c] = -alpha[c];
    }
    add(alpha, p_, x_);
    add(minus, product_, r_);
    precondition();
    const Sums rho = dots(r_, z_, columns_);
    for (std::size_t c = 0; c < columns_; ++c)
      beta[c] = rho_[c] > 0 ? static_cast<float>(rho[c] / rho_[c]) : 0.0f;
    for (std::size_t i = 0; i < p_.size(); i += columns_)
      for (std::size_t c = 0; c < columns_; ++c) p_[i + c] = z_[i + c] + beta[c] * p_[i + c];
    rho_ = rho;
  }

  const Equations& equations_;
  std::size_t columns_;
  std::vector<float> x_, r_, z_, p_, product_;
  Sums rho_, target_;
};

}  // namespace

std::vector<float> fitLattice(const ActiveNodes& nodes, std::span<const LatticeSample> samples,
                              std::span<const float> data, std::size_t columns,
                              std::span<const float> stiffness,
                              std::span<const std::uint32_t> fixed, std::vector<float> start,
                              int steps) {
  CHECK_EQ(data.size(), samples.size() * columns);
  checkpoint();
  const Equations equations(nodes, samples, stiffness, fixed);
  std::vector<float> right_side(nodes.nodes.size() * columns, 0.0f);
  for (std::size_t j = 0; j < samples.size(); ++j)
    for (std::size_t i = 0; i < 8; ++i) {
      const float factor = samples[j].weight * samples[j].share[i];
      float* const to = &right_side[samples[j].node[i] * columns];
      for (std::size_t c = 0; c < columns; ++c) to[c] += factor * data[j * columns + c];
    }
  for (const std::uint32_t n : fixed) std::fill_n(&right_side[n * columns], columns, 0.0f);
  return Solver(equations, std::move(right_side), std::move(start), columns).solve(steps);
}

}  // namespace echocine
