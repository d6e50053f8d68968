#include "boosted_stumps.h"

#include <algorithm>
#include <cmath>

namespace echocine::bench {

namespace {

struct Sample {
  const BoostedStumps::Row* row;
  double side, weight;  // side: 1 or -1
};

}  // namespace

BoostedStumps::BoostedStumps(const std::vector<Row>& positive, const std::vector<Row>& negative,
                             int rounds)
    : numbers_(positive.front().size()) {
  std::vector<Sample> samples;
  for (const Row& row : positive)
    samples.push_back({&row, 1, 0.5 / static_cast<double>(positive.size())});
  for (const Row& row : negative)
    samples.push_back({&row, -1, 0.5 / static_cast<double>(negative.size())});
  // A perfect stump has a finite weight. Our choice.
  const double least_error = 0.5 / static_cast<double>(samples.size());
  for (int round = 0; round < rounds; ++round) {
    Stump best;
    double lowest = 1;
    bool positive_above = true;
    for (std::size_t n = 0; n < numbers_; ++n) {
      std::sort(samples.begin(), samples.end(),
                [n](const Sample& a, const Sample& b) { return (*a.row)[n] < (*b.row)[n]; });
      double error = 0;  // of "positive above the threshold", below all rows
      for (const Sample& s : samples) error += s.side < 0 ? s.weight : 0;
      for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
        error += samples[i].side * samples[i].weight;
        const double here = (*samples[i].row)[n], next = (*samples[i + 1].row)[n];
        if (here == next) continue;
        for (const bool above : {true, false})
          if (const double of = above ? error : 1 - error; of < lowest) {
            lowest = of;
            best = {n, 0.5 * (here + next), 0};
            positive_above = above;
          }
      }
    }
    if (!(lowest < 0.5)) break;
    const double error = std::max(lowest, least_error);
    best.weight = (positive_above ? 0.5 : -0.5) * std::log((1 - error) / error);
    stumps_.push_back(best);
    double sum = 0;
    for (Sample& s : samples) {
      const double says = (*s.row)[best.number] > best.threshold ? 1 : -1;
      sum += s.weight *= std::exp(-best.weight * says * s.side);
    }
    for (Sample& s : samples) s.weight /= sum;
  }
}

double BoostedStumps::of(const Row& x) const {
  double sum = 0;
  for (const Stump& s : stumps_) sum += x[s.number] > s.threshold ? s.weight : -s.weight;
  return sum;
}

std::vector<double> BoostedStumps::shares() const {
  std::vector<double> shares(numbers_, 0.0);
  double sum = 0;
  for (const Stump& s : stumps_) {
    shares[s.number] += std::abs(s.weight);
    sum += std::abs(s.weight);
  }
  for (double& share : shares) share /= sum > 0 ? sum : 1;
  return shares;
}

}  // namespace echocine::bench
