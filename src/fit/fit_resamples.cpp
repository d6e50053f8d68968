#include "fit/fit_resamples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "core/error.h"

namespace echocine::fit {

void checkResamples(int blocks) {
  if (blocks != 0 && (blocks < kLeastResamples || blocks > kMostResamples))
    throw SceneError(fmt::format("resamples: is {}, accepted: 0, or {} to {}", blocks,
                                 kLeastResamples, kMostResamples));
}

double jackknifeSd(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0, sum = 0;
  for (const double value : values) mean += value / n;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt((n - 1) / n * sum);
}

std::vector<double> resampledSds(const std::vector<FitSide>& sides, const FitCost& cost,
                                 const FitPlace& best, int blocks,
                                 const std::shared_ptr<FitJournal>& journal,
                                 const Monitor& monitor) {
  std::vector<std::vector<double>> values(cost.dials());
  for (int block = 0; block < blocks; ++block) {
    const int first = block * kFitFrames / blocks, end = (block + 1) * kFitFrames / blocks;
    std::deque<ModelDiscrepancy> parts;
    std::vector<FitSide> some;
    for (const FitSide& side : sides) {
      parts.push_back(side.discrepancy->without(first, end));
      some.push_back({side.family, &parts.back(), side.look});
    }
    const FitCost part =
        cost.with(std::move(some), {journal, fmt::format("without {} of {}", block, blocks)});
    const FitDescent found = descendFit(part, best, monitor);
    if (found.stopped) return {};
    for (std::size_t i = 0; i < values.size(); ++i) values[i].push_back(found.best.at[i]);
    monitor.tell(
        {Task::settings, static_cast<std::size_t>(block) + 1, static_cast<std::size_t>(blocks)});
  }
  std::vector<double> out;
  for (const std::vector<double>& one : values) out.push_back(jackknifeSd(one));
  return out;
}

void widenBy(const std::vector<double>& sds, std::vector<double>& covariance) {
  const auto n = static_cast<std::size_t>(std::lround(std::sqrt(covariance.size())));
  std::vector<double> factors(n, 1);
  for (std::size_t i = 0; i < sds.size() && i < n; ++i) {
    const double own = std::sqrt(std::max(0.0, covariance[i * n + i]));
    if (own > 0) factors[i] = std::max(1.0, sds[i] / own);
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) covariance[i * n + j] *= factors[i] * factors[j];
}

}  // namespace echocine::fit
