#include "motion/interior/lattice_fit.h"

#include <algorithm>
#include <array>

#include "core/check.h"
#include "core/lanes.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "motion/interior/lattice_equations.h"

namespace echocine {

namespace {

// Our choice: the residual falls to this part of the right-hand side, which leaves micrometres.
constexpr double kTolerance = 1e-4;

// Columns that are solved together: as many as keep a node's sum in registers. Our choice.
constexpr std::size_t kTogether = 3 * kFloatLanes;

struct FitProblem {
  std::span<const LatticeSample> samples;
  std::span<const float> data;
  std::size_t columns;
  std::span<const std::uint32_t> fixed;
};

// Conjugate gradients with the diagonal as preconditioner, for a few columns, each with its own
// steps. Lanes beyond the columns stay 0.
template <std::size_t kLanes>
class ColumnSolver {
 public:
  static constexpr std::size_t kWidth = kLanes * kFloatLanes;

  ColumnSolver(const LatticeEquations& equations, const FitProblem& problem, std::size_t first)
      : equations_(equations),
        problem_(problem),
        first_(first),
        count_(std::min(kWidth, problem.columns - first)),
        x_(equations.size() * kWidth),
        r_(x_.size()),
        p_(x_.size()),
        product_(x_.size()) {}

  // Replaces the columns of `all`, which are where it starts.
  void solve(int steps, std::vector<float>& all) {
    for (std::size_t n = 0; n < size(); ++n)
      std::copy_n(&all[n * problem_.columns + first_], count_, &x_[n * kWidth]);
    makeRightSide();
    const Sums target = Sums::scaled(residual(), kTolerance * kTolerance);
    const Factors none{};
    Factors one;
    one.fill(1);
    multiply(x_);
    rho_ = descend(one);
    turn(none, none);
    for (int i = 0; i < steps && rho_.over(target); ++i) step(target);
    for (std::size_t n = 0; n < size(); ++n)
      std::copy_n(&x_[n * kWidth], count_, &all[n * problem_.columns + first_]);
  }

 private:
  using Factors = std::array<float, kWidth>;  // one per column
  // One double per column.
  struct Sums {
    Doubles4 parts[2 * kLanes]{};
    double operator[](std::size_t c) const { return parts[c / kDoubleLanes][c % kDoubleLanes]; }
    void add(std::size_t lane, Floats8 a, Floats8 b) {
      Floats4 halves[2][2];
      std::memcpy(halves[0], &a, sizeof a);
      std::memcpy(halves[1], &b, sizeof b);
      for (std::size_t h = 0; h < 2; ++h)
        parts[2 * lane + h] += __builtin_convertvector(halves[0][h], Doubles4) *
                               __builtin_convertvector(halves[1][h], Doubles4);
    }
    static Sums scaled(Sums sums, double factor) {
      for (Doubles4& part : sums.parts) part *= factor;
      return sums;
    }
    bool over(const Sums& target) const {
      for (std::size_t c = 0; c < kWidth; ++c)
        if ((*this)[c] > target[c]) return true;
      return false;
    }
  };

  std::size_t size() const { return equations_.size(); }

  void makeRightSide() {
    for (std::size_t j = 0; j < problem_.samples.size(); ++j) {
      const LatticeSample& sample = problem_.samples[j];
      const float* const data = &problem_.data[j * problem_.columns + first_];
      for (std::size_t i = 0; i < 8; ++i) {
        const float factor = sample.weight * sample.share[i];
        float* const to = &r_[sample.node[i] * kWidth];
        for (std::size_t c = 0; c < count_; ++c) to[c] += factor * data[c];
      }
    }
    for (const std::uint32_t n : problem_.fixed) std::fill_n(&r_[n * kWidth], kWidth, 0.0f);
  }

  // r . r over the diagonal.
  Sums residual() const {
    Sums sums;
    for (std::size_t n = 0; n < size(); ++n)
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const Floats8 r = lanesAt(&r_[n * kWidth + lane * kFloatLanes]);
        sums.add(lane, r, r * equations_.inverseDiagonal()[n]);
      }
    return sums;
  }

  // product = A from; returns from . product.
  Sums multiply(const std::vector<float>& from) {
    Sums sums;
    for (std::size_t n = 0; n < size(); ++n) {
      const LatticeEquations::Row row = equations_[n];
      Floats8 sum[kLanes]{};
      for (std::size_t m = 0; m < row.members.size(); ++m) {
        const float* const at = &from[row.members[m] * kWidth];
        for (std::size_t lane = 0; lane < kLanes; ++lane)
          sum[lane] += row.values[m] * lanesAt(at + lane * kFloatLanes);
      }
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::size_t i = n * kWidth + lane * kFloatLanes;
        store(sum[lane], &product_[i]);
        sums.add(lane, lanesAt(&from[i]), sum[lane]);
      }
    }
    return sums;
  }

  // r -= alpha product; returns r . r over the diagonal.
  Sums descend(const Factors& alpha) {
    Sums sums;
    for (std::size_t n = 0; n < size(); ++n)
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::size_t i = n * kWidth + lane * kFloatLanes;
        const Floats8 r =
            lanesAt(&r_[i]) - lanesAt(&alpha[lane * kFloatLanes]) * lanesAt(&product_[i]);
        store(r, &r_[i]);
        sums.add(lane, r, r * equations_.inverseDiagonal()[n]);
      }
    return sums;
  }

  // x += alpha p; p = r over the diagonal + beta p.
  void turn(const Factors& alpha, const Factors& beta) {
    for (std::size_t n = 0; n < size(); ++n)
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::size_t i = n * kWidth + lane * kFloatLanes;
        const Floats8 p = lanesAt(&p_[i]);
        store(lanesAt(&x_[i]) + lanesAt(&alpha[lane * kFloatLanes]) * p, &x_[i]);
        store(lanesAt(&r_[i]) * equations_.inverseDiagonal()[n] +
                  lanesAt(&beta[lane * kFloatLanes]) * p,
              &p_[i]);
      }
  }

  void step(const Sums& target) {
    checkpoint();
    const Sums curvature = multiply(p_);
    Factors alpha, beta;
    for (std::size_t c = 0; c < kWidth; ++c) {
      const bool done = rho_[c] <= target[c] || curvature[c] <= 0;
      alpha[c] = done ? 0.0f : static_cast<float>(rho_[c] / curvature[c]);
    }
    const Sums rho = descend(alpha);
    for (std::size_t c = 0; c < kWidth; ++c)
      beta[c] = rho_[c] > 0 ? static_cast<float>(rho[c] / rho_[c]) : 0.0f;
    turn(alpha, beta);
    rho_ = rho;
  }

  const LatticeEquations& equations_;
  const FitProblem& problem_;
  std::size_t first_, count_;
  std::vector<float> x_, r_, p_, product_;  // kWidth values per node
  Sums rho_;                                // r . r over the diagonal
};

}  // namespace

std::vector<float> fitLattice(const ActiveNodes& nodes, std::span<const LatticeSample> samples,
                              std::span<const float> data, std::size_t columns,
                              std::span<const float> stiffness,
                              std::span<const std::uint32_t> fixed, std::vector<float> start,
                              int steps) {
  CHECK_EQ(data.size(), samples.size() * columns);
  checkpoint();
  const LatticeEquations equations(nodes, samples, stiffness, fixed);
  const FitProblem problem{samples, data, columns, fixed};
  start.resize(nodes.nodes.size() * columns);
  parallelBlocks(columns, kTogether, [&](std::size_t begin, std::size_t end) {
    if (end - begin > 2 * kFloatLanes)
      ColumnSolver<3>(equations, problem, begin).solve(steps, start);
    else if (end - begin > kFloatLanes)
      ColumnSolver<2>(equations, problem, begin).solve(steps, start);
    else
      ColumnSolver<1>(equations, problem, begin).solve(steps, start);
  });
  return start;
}

}  // namespace echocine
