#include "echo/beat_length.h"

#include <algorithm>
#include <cmath>

namespace echocine::echo {

namespace {

double squaredDistance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

// Where a parabola through three equally spaced values is least, from the middle one: -0.5..0.5.
double parabolaOffset(double left, double middle, double right) {
  const double bend = left - 2 * middle + right;
  return bend > 0 ? std::clamp(0.5 * (left - right) / bend, -0.5, 0.5) : 0;
}

// Our choice.
constexpr double kClearlyBetter = 1.15, kLeastDrop = 0.25;
// d of unrelated frames. Frames half or a third of a beat apart differ more, because the
// fundamental is the strongest part of a heart's motion; frames a beat apart differ less.
constexpr double kUnrelated = 1;

// 2 or more if `later` is as many times `earlier`, within a tenth (our choice); else 1.
double timesOf(double later, double earlier) {
  const double times = std::round(later / earlier);
  return times > 1 && std::abs(later / earlier / times - 1) < 0.1 ? times : 1;
}

}  // namespace

// d is 0 for equal frames and 1 for unrelated ones, since |a - b|^2 averages to 2 |a|^2 where a and
// b have nothing in common.
BeatLength findBeatLength(const Features& features, double shortest) {
  const auto n = static_cast<int>(features.size());
  BeatLength beat;
  double energy = 0;
  for (const auto& f : features) energy += squaredDistance(f, std::vector<double>(f.size(), 0));
  energy /= std::max(1, n);
  std::vector<double>& d = beat.dissimilarity;
  for (int lag = 0; lag < n; ++lag) {
    double sum = 0;
    for (int j = 0; j + lag < n; ++j)
      sum += squaredDistance(features[static_cast<std::size_t>(j)],
                             features[static_cast<std::size_t>(j + lag)]);
    d.push_back(energy > 0 ? sum / (n - lag) / (2 * energy) : 0);
  }
  // The last lag has one pair of frames alone: too few to be a minimum. Three frames are no beat.
  const int last = n - 2, first = std::max(3, static_cast<int>(std::ceil(shortest)));
  if (last <= first) return beat;
  // The greatest rise before a lag says how far the loop went away before it came back.
  double away = 0, best_drop = 0, best_d = kUnrelated;
  for (int lag = 1; lag <= last; ++lag) {
    const auto at = static_cast<std::size_t>(lag);
    if (lag >= first && d[at] < d[at - 1] && d[at] <= d[at + 1]) {
      const double drop = away > 0 ? (away - d[at]) / away : 0;
      // A later beat must be clearly better. A multiple of a beat only refines it: breathing and
      // alternating beats make frames two or three beats apart match better than one beat apart.
      if (drop > kClearlyBetter * best_drop && drop > kLeastDrop) {
        const double times = best_d < kUnrelated ? timesOf(lag, beat.frames) : 1;
        if (times == 1) best_d = d[at];
        best_drop = drop;
        beat.frames = (lag + parabolaOffset(d[at - 1], d[at], d[at + 1])) / times;
      }
    }
    away = std::max(away, d[at]);
  }
  if (beat.frames > 0) {
    beat.confidence = std::clamp(best_drop, 0.0, 1.0);
    beat.source = "self-similarity";
    return beat;
  }
  // One beat: still falling at the end. The step from the last frame to the first of the next beat
  // is as long as the others.
  const double drop = away > 0 ? (away - d[static_cast<std::size_t>(n) - 1]) / away : 0;
  // Our choice: higher than above, for nothing behind the end confirms it.
  if (drop > 0.4) {
    beat.frames = n;
    beat.confidence = std::clamp(drop, 0.0, 1.0);
    beat.source = "loop closes";
  }
  return beat;
}

}  // namespace echocine::echo
