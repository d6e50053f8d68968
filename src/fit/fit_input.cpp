#include "fit/fit_input.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "echo/beat_length.h"
#include "echo/persistence.h"
#include "fit/fit_doubts.h"
#include "fit/own_look_fit.h"

namespace echocine::fit {

double motionOf(const echo::EchoLoop& loop) {
  const auto frames = static_cast<double>(loop.video.frames.size());
  double pixels = 0, sum = 0, square = 0, over_time = 0;
  for (int y = 0; y < loop.video.height; ++y)
    for (int x = 0; x < loop.video.width; ++x) {
      const auto p = static_cast<std::size_t>(y * loop.video.width + x);
      if (!loop.sector().contains(x + 0.5, y + 0.5) || loop.overlay[p] != 0) continue;
      double mean = 0, own = 0;
      for (const PixelPlane& frame : loop.video.frames) {
        mean += frame[p] / frames;
        own += static_cast<double>(frame[p]) * frame[p] / frames;
      }
      ++pixels;
      sum += mean;
      square += mean * mean;
      over_time += own - mean * mean;
    }
  if (!(pixels > 0)) return 0;
  const double over_picture = square - sum * sum / pixels;
  return over_picture > 0 ? over_time / over_picture : 0;
}

void checkMoves(const FitLoop& one) {
  if (motionOf(one.loop) < kLeastMotion)
    throw SceneError(fmt::format("{}: {}: the pictures do not change: give a loop of a whole beat",
                                 keyOf(one.view), one.loop.video.name));
}

std::vector<std::string> notesOf(const FitLoop& one) {
  std::vector<std::string> out;
  for (const std::string& note : one.loop.video.notes)
    out.push_back(fmt::format("{}: {}", keyOf(one.view), note));
  return out;
}

std::vector<std::optional<double>> persistencesOf(const std::vector<FitLoop>& loops) {
  std::vector<std::optional<double>> out;
  for (const FitLoop& one : loops) out.push_back(echo::persistenceOf(one.loop));
  return out;
}

// Only rendered loops show what averaging over time hides.
bool ownLookFor(const std::vector<std::optional<double>>& persistence,
                const HeartFitOptions& options) {
  if (options.own_look || persistence.size() > 1) return options.ownLook(persistence.size());
  return persistence.front().value_or(0) >= kMuchPersistence;
}

double leastAgreement(const std::vector<std::optional<double>>& persistence,
                      const HeartFitOptions& options) {
  const bool lags =
      std::any_of(persistence.begin(), persistence.end(),
                  [](std::optional<double> p) { return p.value_or(0) >= kMuchPersistence; });
  return lags || options.own_look.value_or(false) ? 0 : kLeastAgreement;
}

std::optional<double> rateOf(const std::vector<FitLoop>& loops, std::vector<std::string>& hints) {
  std::vector<double> rates;
  for (const FitLoop& one : loops) {
    const echo::BeatLength length = echo::beatOf(one.loop);
    const double hz = one.loop.video.rate.hz;
    if (length.frames > 0 && hz > 0) rates.push_back(60 * hz / length.frames);
  }
  if (rates.empty()) return std::nullopt;
  const auto [low, high] = std::minmax_element(rates.begin(), rates.end());
  constexpr double kMostApart = 1.15;
  if (*high > kMostApart * *low)
    hints.push_back(fmt::format(
        "heart rates of the loops are {:.0f} to {:.0f} bpm: are they of one heart?", *low, *high));
  double sum = 0;
  for (const double rate : rates) sum += rate / static_cast<double>(rates.size());
  constexpr double kLeast_bpm = 40, kMost_bpm = 150;
  return std::clamp(sum, kLeast_bpm, kMost_bpm);
}

}  // namespace echocine::fit
