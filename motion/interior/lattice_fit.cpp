#include "motion/interior/lattice_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "motion/interior/column_sums.h"
#include "motion/interior/lattice_equations.h"
#include "motion/interior/multigrid.h"
#include "motion/interior/node_columns.h"

namespace echocine {

namespace {

// The residual of a single-precision round is solved for in further rounds: gain of each round, and
// largest number of rounds. Our choices: two rounds reach 1e-6.
constexpr double kRoundGain = 1e-3;
constexpr int kMostRounds = 8;
// Steps of a round, at most; 7 are enough for hearts.
constexpr int kMostSteps = 60;

// Columns that are solved together: as many as keep a node's sum in registers. Our choice.
constexpr std::size_t kTogether = 3 * kFloatLanes;

struct FitProblem {
  std::span<const LatticeSample> samples;
  std::span<const float> data;
  std::size_t columns;
  std::span<const std::uint32_t> fixed;
  double tolerance;
};

// Conjugate gradients with a cycle of multigrid as preconditioner, for a few columns, each with its
// own steps. They run in single precision, and their result is refined in double: what a smooth
// field leaves of the right side is too small a difference for floats. Lanes beyond the columns
// stay 0.
template <std::size_t kLanes>
class ColumnSolver {
 public:
  static constexpr std::size_t kWidth = kLanes * kFloatLanes;

  ColumnSolver(const LatticeEquations& equations, const Multigrid& grid, const FitProblem& problem,
               std::size_t first)
      : equations_(equations),
        rows_(grid.levels().front().rows),
        cycle_(grid),
        problem_(problem),
        first_(first),
        count_(std::min(kWidth, problem.columns - first)),
        x_(equations.rows().size() * kWidth),
        b_(x_.size()),
        e_(x_.size()),
        r_(x_.size()),
        z_(x_.size()),
        p_(x_.size()),
        product_(x_.size()) {}

  // Replaces the columns of `all`, which are where it starts. Returns the worst column's residual
  // in parts of the right side. If it is not started, they are 0.
  double solve(std::vector<float>& all, bool started) {
    for (std::size_t n = 0; started && n < size(); ++n)
      std::copy_n(&all[n * problem_.columns + first_], count_, &x_[n * kWidth]);
    makeRightSide();
    const double share = problem_.tolerance * problem_.tolerance;
    const Sums target = Sums::scaled(squaresOf(b_), share);
    Sums left = started ? findResidual() : takeRightSide();
    for (int round = 0; round < kMostRounds && left.over(target); ++round) {
      const Sums reached = refine(
          Sums::larger(Sums::scaled(target, 0.5), Sums::scaled(left, kRoundGain * kRoundGain)));
      // A single-precision round knows its residual well enough for a coarse tolerance.
      left = problem_.tolerance > kRoundGain ? reached : findResidual();
    }
    for (std::size_t n = 0; n < size(); ++n)
      for (std::size_t c = 0; c < count_; ++c)
        all[n * problem_.columns + first_ + c] = static_cast<float>(x_[n * kWidth + c]);
    double worst = 0;
    for (std::size_t c = 0; c < count_; ++c)
      if (target[c] > 0) worst = std::max(worst, std::sqrt(left[c] / target[c]));
    return problem_.tolerance * worst;
  }

 private:
  using Factors = std::array<float, kWidth>;  // one per column
  using Sums = ColumnSums<kLanes>;

  std::size_t size() const { return equations_.rows().size(); }

  void makeRightSide() {
    for (std::size_t j = 0; j < problem_.samples.size(); ++j) {
      const LatticeSample& sample = problem_.samples[j];
      const float* const data = &problem_.data[j * problem_.columns + first_];
      for (std::size_t i = 0; i < 8; ++i) {
        const double factor =
            static_cast<double>(sample.weight) * static_cast<double>(sample.share[i]);
        double* const to = &b_[sample.node[i] * kWidth];
        for (std::size_t c = 0; c < count_; ++c) to[c] += factor * static_cast<double>(data[c]);
      }
    }
    for (const std::uint32_t n : problem_.fixed) std::fill_n(&b_[n * kWidth], kWidth, 0.0);
  }

  static Sums squaresOf(const std::vector<double>& values) {
    Sums sums;
    for (std::size_t i = 0; i < values.size(); i += kWidth)
      for (std::size_t part = 0; part < 2 * kLanes; ++part) {
        const Doubles4 v = lanesAt(&values[i + part * kDoubleLanes]);
        sums.parts[part] += v * v;
      }
    return sums;
  }

  // r = b, which is the residual where x is 0. Returns r . r.
  Sums takeRightSide() {
    std::transform(b_.begin(), b_.end(), r_.begin(),
                   [](double b) { return static_cast<float>(b); });
    return squaresOf(b_);
  }

  // r = b - A x, from doubles. Returns r . r.
  Sums findResidual() {
    Sums sums;
    for (std::size_t n = 0; n < size(); ++n) {
      const auto row = equations_.rows()[n];
      Doubles4 r[2 * kLanes];
      for (std::size_t part = 0; part < 2 * kLanes; ++part)
        r[part] = lanesAt(&b_[n * kWidth + part * kDoubleLanes]);
      for (std::size_t m = 0; m < row.members.size(); ++m) {
        const double* const at = &x_[row.members[m] * kWidth];
        for (std::size_t part = 0; part < 2 * kLanes; ++part)
          r[part] -= row.values[m] * lanesAt(at + part * kDoubleLanes);
      }
      for (std::size_t part = 0; part < 2 * kLanes; ++part) {
        sums.parts[part] += r[part] * r[part];
        const Floats4 rounded = __builtin_convertvector(r[part], Floats4);
        std::memcpy(&r_[n * kWidth + part * kDoubleLanes], &rounded, sizeof rounded);
      }
    }
    return sums;
  }

  // x += e, where A e = r until r . r is below the target. Returns r . r as the steps update it.
  Sums refine(const Sums& target) {
    std::fill(e_.begin(), e_.end(), 0.0f);
    std::fill(p_.begin(), p_.end(), 0.0f);
    cycle_.apply(r_, z_);
    rho_ = products(r_, z_);
    turn(Factors{});
    Sums left;
    for (int i = 0; i < kMostSteps && !step(target, left); ++i) {
    }
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += static_cast<double>(e_[i]);
    return left;
  }

  static Sums products(const std::vector<float>& a, const std::vector<float>& b) {
    Sums sums;
    for (std::size_t i = 0; i < a.size(); i += kWidth)
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        sums.add(lane, lanesAt(&a[i + lane * kFloatLanes]), lanesAt(&b[i + lane * kFloatLanes]));
    return sums;
  }

  // product = A p; returns p . product.
  Sums multiply() {
    Sums sums;
    for (std::size_t n = 0; n < size(); ++n) {
      const auto row = rows_[n];
      const auto sum = NodeColumns<kLanes>::product(row, 0, row.members.size(), p_);
      sum.putTo(product_, n);
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        sums.add(lane, lanesAt(&p_[n * kWidth + lane * kFloatLanes]), sum.lanes[lane]);
    }
    return sums;
  }

  // e += alpha p, r -= alpha product; returns r . r.
  Sums advance(const Factors& alpha) {
    Sums sums;
    for (std::size_t i = 0; i < r_.size(); i += kWidth)
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::size_t at = i + lane * kFloatLanes;
        const Floats8 factor = lanesAt(&alpha[lane * kFloatLanes]);
        store(lanesAt(&e_[at]) + factor * lanesAt(&p_[at]), &e_[at]);
        const Floats8 r = lanesAt(&r_[at]) - factor * lanesAt(&product_[at]);
        store(r, &r_[at]);
        sums.add(lane, r, r);
      }
    return sums;
  }

  // p = z + beta p.
  void turn(const Factors& beta) {
    for (std::size_t i = 0; i < p_.size(); i += kWidth)
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::size_t at = i + lane * kFloatLanes;
        store(lanesAt(&z_[at]) + lanesAt(&beta[lane * kFloatLanes]) * lanesAt(&p_[at]), &p_[at]);
      }
  }

  // True when all columns have come to the target. left: r . r after the step.
  bool step(const Sums& target, Sums& left) {
    checkpoint();
    const Sums curvature = multiply();
    Factors alpha, beta;
    for (std::size_t c = 0; c < kWidth; ++c)
      alpha[c] = curvature[c] > 0 ? static_cast<float>(rho_[c] / curvature[c]) : 0.0f;
    left = advance(alpha);
    if (!left.over(target)) return true;
    cycle_.apply(r_, z_);
    const Sums rho = products(r_, z_);
    for (std::size_t c = 0; c < kWidth; ++c)
      beta[c] = rho_[c] > 0 ? static_cast<float>(rho[c] / rho_[c]) : 0.0f;
    turn(beta);
    rho_ = rho;
    return false;
  }

  const LatticeEquations& equations_;
  const SparseRows<float>& rows_;  // the same equations, rounded
  MultigridCycle<kLanes> cycle_;
  const FitProblem& problem_;
  std::size_t first_, count_;
  std::vector<double> x_, b_;                   // kWidth values per node
  std::vector<float> e_, r_, z_, p_, product_;  // of a round
  Sums rho_;                                    // r . z
};

}  // namespace

LatticeFit::LatticeFit(const ActiveNodes& nodes, std::span<const LatticeSample> samples,
                       std::span<const float> stiffness, const std::vector<bool>& own,
                       std::span<const std::uint32_t> fixed)
    : nodes_(nodes), samples_(samples), own_(own), fixed_(fixed.begin(), fixed.end()) {
  update(stiffness);
}

void LatticeFit::update(std::span<const float> stiffness) {
  checkpoint();
  std::vector<float> weights;
  weights.reserve(samples_.size());
  for (const LatticeSample& sample : samples_) weights.push_back(sample.weight);
  if (equations_ && weights == weights_) {
    std::vector<bool> changed(stiffness.size());
    for (std::size_t n = 0; n < changed.size(); ++n) changed[n] = stiffness[n] != stiffness_[n];
    auto equations = std::make_unique<LatticeEquations>(nodes_, samples_, stiffness, own_, fixed_,
                                                        *equations_, changed);
    grid_ = std::make_unique<Multigrid>(nodes_, equations->rows(), grid_.get(), std::move(changed));
    equations_ = std::move(equations);
  } else {
    equations_ = std::make_unique<LatticeEquations>(nodes_, samples_, stiffness, own_, fixed_);
    grid_ = std::make_unique<Multigrid>(nodes_, equations_->rows());
  }
  stiffness_.assign(stiffness.begin(), stiffness.end());
  weights_ = std::move(weights);
  checkpoint();
}

LatticeFit::~LatticeFit() = default;

LatticeFit::Solution LatticeFit::solve(std::span<const float> data, std::size_t columns,
                                       std::vector<float> start, double tolerance) const {
  CHECK_EQ(data.size(), samples_.size() * columns);
  const FitProblem problem{samples_, data, columns, fixed_, tolerance};
  const bool started = !start.empty();
  start.resize(equations_->rows().size() * columns);
  std::vector<double> left(columns, 0.0);  // by first column of a block
  parallelBlocks(columns, kTogether, [&](std::size_t begin, std::size_t end) {
    if (end - begin > 2 * kFloatLanes)
      left[begin] = ColumnSolver<3>(*equations_, *grid_, problem, begin).solve(start, started);
    else if (end - begin > kFloatLanes)
      left[begin] = ColumnSolver<2>(*equations_, *grid_, problem, begin).solve(start, started);
    else
      left[begin] = ColumnSolver<1>(*equations_, *grid_, problem, begin).solve(start, started);
  });
  return {std::move(start), columns > 0 ? *std::max_element(left.begin(), left.end()) : 0.0};
}

}  // namespace echocine
