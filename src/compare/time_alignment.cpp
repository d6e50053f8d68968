#include "compare/time_alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/time_search.h"

namespace echocine::compare {

namespace {

// synthetic place = shift + rate * real frame, both in frames; mean and spread over the shifts that
// were tried.
struct StraightMap {
  double shift = 0, rate = 1, correlation = -2, mean = 0, spread = 0;
};

// All shifts at one rate, a quarter of a frame apart.
StraightMap bestShift(const TimeSearch& search, const TimeProblem& p, double rate) {
  StraightMap best;
  best.rate = rate;
  const double n = static_cast<double>(p.synthetic.size());
  // A beat of shifts says all of a periodic loop; another may begin half its length before the real
  // one.
  const double from = search.periodic() ? 0 : -0.5 * rate * static_cast<double>(p.real.size());
  const double to = search.periodic() ? p.synthetic_beat : n;
  double sum = 0, squares = 0;
  int count = 0;
  // Past this pace no shift has half of the real frames inside; trying them all would take for
  // ever.
  constexpr double kMostLoops = 8;
  if (!search.periodic() && rate * static_cast<double>(p.real.size()) > kMostLoops * n) return best;
  for (double shift = from; shift < to; shift += 0.25) {
    const double c = search.straight(shift, rate);
    if (c <= -1) continue;
    sum += c, squares += c * c, ++count;
    if (c > best.correlation) best.correlation = c, best.shift = shift;
  }
  if (count > 0) {
    best.mean = sum / count;
    best.spread = std::sqrt(std::max(0.0, squares / count - best.mean * best.mean));
  }
  return best;
}

// Shift and rate to a hundredth of a frame by ever smaller steps about the best so far.
void refine(const TimeSearch& search, bool rate_known, double frames, StraightMap& map) {
  for (double step = 0.125; step > 0.004; step /= 2)
    for (bool better = true; better;) {
      better = false;
      const double rate_step = rate_known ? 0 : step / std::max(1.0, frames);
      for (const auto& [ds, dr] : {std::pair(step, 0.0), std::pair(-step, 0.0),
                                   std::pair(0.0, rate_step), std::pair(0.0, -rate_step)}) {
        if (ds == 0 && dr == 0) continue;
        const double c = search.straight(map.shift + ds, map.rate + dr);
        if (c > map.correlation + 1e-12) {
          map.shift += ds, map.rate += dr, map.correlation = c;
          better = true;
        }
      }
    }
}

// Offsets from the straight map, real frame by real frame (Viterbi over eighths of a frame).
std::vector<double> warpOffsets(const TimeSearch& search, const TimeProblem& p,
                                const StraightMap& map) {
  constexpr double kStep = 0.125;
  constexpr double kPaceCost = 0.05;  // of correlation, for a doubled or stopped pace; our choice
  const double beat =
      p.synthetic_beat > 0 ? p.synthetic_beat : static_cast<double>(p.synthetic.size());
  // An eighth of a beat either way, our choice: beats of one heart differ by less.
  const int reach = std::max(1, static_cast<int>(0.12 * beat / kStep));
  const int states = 2 * reach + 1, most = std::max(1, static_cast<int>(map.rate / kStep));
  const std::size_t m = p.real.size();
  std::vector<std::vector<int>> from(m, std::vector<int>(static_cast<std::size_t>(states), 0));
  std::vector<double> cost(static_cast<std::size_t>(states), 0), next;
  const auto own = [&](std::size_t j, int s) {
    if (!search.used(j)) return 0.0;
    const double place = map.shift + map.rate * static_cast<double>(j) + (s - reach) * kStep;
    return 1 - search.at(place, j);
  };
  for (int s = 0; s < states; ++s) cost[static_cast<std::size_t>(s)] = own(0, s);
  for (std::size_t j = 1; j < m; ++j) {
    next.assign(static_cast<std::size_t>(states), std::numeric_limits<double>::infinity());
    for (int s = 0; s < states; ++s)
      // Never backwards: the offset falls by no more than a straight step; nor more than doubled.
      for (int q = std::max(0, s - most); q <= std::min(states - 1, s + most); ++q) {
        const double pace = (s - q) * kStep / map.rate;
        const double c = cost[static_cast<std::size_t>(q)] + kPaceCost * pace * pace;
        if (c < next[static_cast<std::size_t>(s)]) {
          next[static_cast<std::size_t>(s)] = c;
          from[j][static_cast<std::size_t>(s)] = q;
        }
      }
    for (int s = 0; s < states; ++s) next[static_cast<std::size_t>(s)] += own(j, s);
    cost = next;
  }
  auto s = static_cast<int>(std::min_element(cost.begin(), cost.end()) - cost.begin());
  std::vector<double> offsets(m, 0);
  for (std::size_t j = m; j-- > 0;) {
    offsets[j] = (s - reach) * kStep;
    s = from[j][static_cast<std::size_t>(s)];
  }
  return offsets;
}

// The mean correlation over the frames that count, as summary.json has it.
void measure(const TimeSearch& search, TimeAlignment& out) {
  double sum = 0;
  int count = 0;
  for (std::size_t j = 0; j < out.place.size(); ++j)
    if (search.used(j) && out.place[j] >= 0) sum += search.at(out.place[j], j), ++count;
  out.correlation = count > 0 ? sum / count : 0;
}

// Places as the public contract has them: within the beat, or negative outside the loop.
void settlePlaces(const TimeProblem& p, TimeAlignment& out) {
  const double last = static_cast<double>(p.synthetic.size()) - 1;
  for (double& place : out.place) {
    if (out.periodic)
      place -= p.synthetic_beat * std::floor(place / p.synthetic_beat);
    else if (place < -0.5 || place > last + 0.5)
      place = -1;
    else
      place = std::clamp(place, 0.0, last);
  }
}

}  // namespace

TimeAlignment alignInTime(const TimeProblem& p) {
  const TimeSearch search(p);
  const bool rate_known = p.synthetic_beat > 0 && p.real_beat > 0;
  StraightMap best;
  if (rate_known) {
    best = bestShift(search, p, p.synthetic_beat / p.real_beat);
  } else {
    for (int i = -8; i <= 8; ++i) {  // up to a third slower or faster than the stated rates say
      const StraightMap map = bestShift(search, p, p.nominal_rate * std::pow(1.5, i / 8.0));
      // Another pace than stated has to be worth it.
      if (map.correlation - 0.005 * std::abs(i) > best.correlation) best = map;
    }
  }
  const double coarse = best.correlation;
  refine(search, rate_known, static_cast<double>(p.real.size()), best);
  TimeAlignment out;
  out.method = "found by dynamic time warping";
  out.periodic = search.periodic();
  out.shift_frames = best.shift;
  out.rate = best.rate;
  out.confidence = std::clamp((coarse - best.mean) / (1 - std::min(0.99, best.mean)), 0.0, 1.0);
  const std::vector<double> offsets = warpOffsets(search, p, best);
  TimeAlignment straight = out;
  for (std::size_t j = 0; j < p.real.size(); ++j) {
    const double place = best.shift + best.rate * static_cast<double>(j);
    straight.place.push_back(place);
    out.place.push_back(place + offsets[j]);
    out.largest_warp_frames = std::max(out.largest_warp_frames, std::abs(offsets[j]));
  }
  settlePlaces(p, out);
  settlePlaces(p, straight);
  measure(search, out);
  measure(search, straight);
  // Warping always gains a little; what it gains must be more than that.
  return out.correlation > straight.correlation + 0.01 ? out : straight;
}

TimeAlignment alignByAnchors(const TimeProblem& p, std::vector<Anchor> anchors) {
  const TimeSearch search(p);
  std::sort(anchors.begin(), anchors.end(), [](Anchor a, Anchor b) { return a.real < b.real; });
  TimeAlignment out;
  out.periodic = search.periodic();
  double pace = p.nominal_rate;
  // The anchors repeat a beat later and a beat earlier, so that frames outside them are between two
  // as well: the first one after those of one beat, else the last one.
  if (p.synthetic_beat > 0 && p.real_beat > 0) {
    pace = p.synthetic_beat / p.real_beat;
    const Anchor first = anchors.front(), last = anchors.back();
    const bool is_one_beat =
        last.real - first.real < p.real_beat && last.synthetic - first.synthetic < p.synthetic_beat;
    const Anchor next = is_one_beat ? first : last, before = is_one_beat ? last : first;
    anchors.push_back({next.real + p.real_beat, next.synthetic + p.synthetic_beat});
    anchors.insert(anchors.begin(),
                   {before.real - p.real_beat, before.synthetic - p.synthetic_beat});
  }
  for (std::size_t j = 0; j < p.real.size(); ++j) {
    const auto x = static_cast<double>(j);
    std::size_t k = 0;
    while (k + 1 < anchors.size() && anchors[k + 1].real <= x) ++k;
    const Anchor a = anchors[k];
    const bool between = k + 1 < anchors.size() && x >= a.real;
    const double slope =
        between ? (anchors[k + 1].synthetic - a.synthetic) / (anchors[k + 1].real - a.real) : pace;
    out.place.push_back(a.synthetic + slope * (x - a.real));
  }
  out.shift_frames = out.place.front();
  out.rate = pace;
  settlePlaces(p, out);
  measure(search, out);
  out.confidence = 1;
  return out;
}

}  // namespace echocine::compare
