#include "fit/fit_starts.h"

#include <algorithm>

#include "core/error.h"

namespace echocine::fit {

namespace {

std::vector<std::vector<double>> startsOf(const FitCost& cost, int count) {
  constexpr std::uint64_t kSeed = 34;
  std::vector<std::vector<double>> out;
  for (int n = 0; n < count; ++n) {
    const auto number = static_cast<std::size_t>(n);
    const PriorDials dials =
        HeartPrior::dialsOf(number < heartGroups().size() ? heartGroups()[number].mean
                                                          : cost.prior().draw(kSeed, number));
    std::vector<double> at(cost.unknowns().size(), 0);
    for (std::size_t i = 0; i < cost.dials(); ++i) {
      const FitUnknown& u = cost.unknowns()[i];
      if (const auto p = priorDialOf(u.name))
        at[i] = std::clamp(dials[*p], u.low + u.step, u.high - u.step);
      else if (const LonePrior* lone = lonePriorOf(u.name))
        at[i] = lone->median;
    }
    out.push_back(std::move(at));
  }
  return out;
}

}  // namespace

FitStarts startPlaces(const FitCost& cost, int count, const Monitor& monitor) {
  FitStarts out;
  try {
    for (const std::vector<double>& at : startsOf(cost, count)) {
      if (!monitor.keep_going()) throw JobError("stopped while a heart was fitted");
      out.places.push_back(cost.at(at, {}));
      monitor.tell({Task::settings, out.places.size(), static_cast<std::size_t>(count)});
    }
  } catch (const JobError&) {
    if (out.places.empty() || monitor.keep_going()) throw;
    out.stopped = true;
  }
  std::stable_sort(out.places.begin(), out.places.end(),
                   [](const FitPlace& a, const FitPlace& b) { return a.cost < b.cost; });
  return out;
}

}  // namespace echocine::fit
