#pragma once
// How well real frames correlate with instants of the synthetic loop.

#include <vector>

#include "compare/time_alignment.h"
#include "echo/frame_blend.h"

namespace echocine::compare {

// Correlations of blended synthetic frames with real ones, from inner products alone.
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

  // Does real frame j say anything of its own?
  bool used(std::size_t j) const { return used_[j]; }

  // Mean correlation of a straight map, place = shift + rate j; places outside the synthetic loop
  // are left out, but half of the real frames must be inside, else -1.
  double straight(double shift, double rate) const;

 private:
  const TimeProblem& p_;
  Correlations correlations_;
  int n_;
  bool periodic_ = false;
  std::vector<bool> used_;
};

}  // namespace echocine::compare
