#pragma once
// The hearts that a family computes, and the share of each in a heart between them.

#include <vector>

#include "fit/dial_checks.h"

namespace echocine::fit {

class HeartDesign {
 public:
  HeartDesign() = default;
  // Every combination of Chebyshev-Lobatto nodes, the first dial fastest. Shares interpolate.
  static HeartDesign grid(const std::vector<DialRange>& ranges, int nodes);
  // Places for a polynomial of total degree 2 in all dials and 3 in the first two; later
  // dials of heart::SectionShape have degree 1, alone and times the first two. The centre, then one
  // at a time the place of a 4^n lattice where the polynomial is least certain (Fedorov, Theory of
  // Optimal Experiments, 1972), a fifth more than terms. With more than nine dials, the
  // candidates are 4^8 draws of the lattice. Shares are those of least squares.
  // Throws SceneError for more than kMostHearts.
  static HeartDesign polynomial(const std::vector<DialRange>& ranges);

  std::size_t size() const { return places_.size(); }
  const std::vector<DialRange>& ranges() const { return ranges_; }
  int nodes() const { return nodes_; }  // of each dial in a grid; 0: a polynomial
  // Values by dial.
  std::vector<double> at(std::size_t place) const;
  // Moves a place of a polynomial towards the centre by a quarter of its distance: a heart with
  // such dials may not exist. Call settle() when all hearts are known.
  void moveIn(std::size_t place);
  void settle();

  // By heart; the sum is 1. Precondition: values within the ranges.
  std::vector<float> shares(const std::vector<double>& values) const;
  // Bound of the sum of |share| within the ranges.
  double overshoot() const { return overshoot_; }

 private:
  std::vector<double> unit(const std::vector<double>& values) const;  // -1 to 1
  std::vector<double> sharesOf(const std::vector<double>& unit) const;

  std::vector<DialRange> ranges_;
  int nodes_ = 0;
  std::vector<std::vector<double>> places_;  // in units
  std::vector<std::vector<int>> powers_;     // of a term, by dial
  std::vector<double> solver_;               // share of a place by term, terms x places
  double overshoot_ = 1;
};

}  // namespace echocine::fit
