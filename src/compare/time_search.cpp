#include "compare/time_search.h"

#include <algorithm>
#include <cmath>

namespace echocine::compare {

namespace {

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

Correlations::Correlations(const TimeProblem& p) {
  for (const auto& s : p.synthetic) {
    std::vector<double> row, own;
    for (const auto& r : p.real) row.push_back(product(s, r));
    for (const auto& t : p.synthetic) own.push_back(product(s, t));
    cross_.push_back(std::move(row));
    own_.push_back(std::move(own));
  }
  for (const auto& r : p.real) real_.push_back(std::sqrt(product(r, r)));
}

double Correlations::of(const echo::Blend& blend, std::size_t real) const {
  const double u = 1 - blend.share, v = blend.share;
  const double norm = u * u * own_[blend.a][blend.a] + 2 * u * v * own_[blend.a][blend.b] +
                      v * v * own_[blend.b][blend.b];
  const double length = std::sqrt(std::max(0.0, norm)) * real_[real];
  return length > 0 ? (u * cross_[blend.a][real] + v * cross_[blend.b][real]) / length : 0;
}

TimeSearch::TimeSearch(const TimeProblem& p)
    : p_(p), correlations_(p), n_(static_cast<int>(p.synthetic.size())) {
  // A loop that ends up to a frame and a half before its beat still closes.
  periodic_ = p.synthetic_beat > 0 && p.synthetic_beat <= n_ + 1.5;
  used_.assign(p.real.size(), true);
  for (const int r : p.repeats) used_[static_cast<std::size_t>(r)] = false;
}

double TimeSearch::at(double place, std::size_t j) const {
  const echo::Blend blend = echo::blendAt(place, n_, p_.synthetic_beat, periodic_);
  return blend.inside ? correlations_.of(blend, j) : -1;
}

double TimeSearch::straight(double shift, double rate) const {
  double sum = 0;
  int count = 0, wanted = 0;
  for (std::size_t j = 0; j < p_.real.size(); ++j) {
    if (!used_[j]) continue;
    ++wanted;
    const echo::Blend blend =
        echo::blendAt(shift + rate * static_cast<double>(j), n_, p_.synthetic_beat, periodic_);
    if (!blend.inside) continue;
    sum += correlations_.of(blend, j);
    ++count;
  }
  return 2 * count >= wanted && count > 0 ? sum / count : -1;
}

}  // namespace echocine::compare
