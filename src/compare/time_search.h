#pragma once
// Correlation of real frames with instants of the synthetic loop.

#include <vector>

#include "compare/time_alignment.h"
#include "echo/frame_blend.h"

namespace echocine::compare {

// Correlations of blended synthetic frames with real ones, computed from inner products.
class Correlations {
 public:
  explicit Correlations(const TimeProblem& p);
  double of(const echo::Blend& blend, std::size_t real) const;  // -1..1

 private:
  std::vector<std::vector<double>> cross_, own_;  // [synthetic][real], [synthetic][synthetic]
  std::vector<double> real_;                      // lengths
};

// Precondition: the problem outlives the search.
class TimeSearch {
 public:
  explicit TimeSearch(const TimeProblem& p);

  // Does the synthetic loop close after a beat?
  bool periodic() const { return periodic_; }

  // Correlation of real frame j with the synthetic loop at `place`, in frames; -1 outside it.
  double at(double place, std::size_t j) const;

  // Is real frame j used? Repeats are not.
  bool used(std::size_t j) const { return used_[j]; }

  // Mean correlation of a linear map, place = shift + rate j. Places outside the synthetic loop are
  // omitted; -1 if fewer than half of the real frames are inside.
  double straight(double shift, double rate) const;

 private:
  const TimeProblem& p_;
  Correlations correlations_;
  int n_;
  bool periodic_ = false;
  std::vector<bool> used_;
};

}  // namespace echocine::compare
