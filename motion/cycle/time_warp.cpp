#include "motion/cycle/time_warp.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "motion/cycle/cardiac_timing.h"

namespace echocine {

namespace {

// The same parts with end-systole at a given fraction of the beat: systole and diastole each keep
// their proportions.
PhaseDurations withEndSystole(const PhaseDurations& d, double share) {
  const double systole = share * d.beat() / d.endSystole();
  const double rest = (1 - share) * d.beat() / (d.beat() - d.endSystole());
  return {systole * d.isovolumic_contraction_s,
          systole * d.ejection_s,
          rest * d.isovolumic_relaxation_s,
          rest * d.rapid_filling_s,
          rest * d.diastasis_s,
          rest * d.atrial_kick_s};
}

double odds(double share) {
  return share / (1 - share);
}

// Two beats whose events are aligned.
struct BeatPair {
  PhaseDurations played, recorded;
};

BeatPair beatsOf(const RecordedBeat& recorded, double beat_s) {
  BeatPair pair{phaseDurations(1 / beat_s), phaseDurations(recorded.heart_rate_hz)};
  if (!recorded.end_systole_phase) return pair;
  const double anchor = *recorded.end_systole_phase;
  // Odds lie between 0 and infinity, so systole stays within the beat at every rate.
  const double played = odds(cycleEvents(pair.played).aortic_closes) * odds(anchor) /
                        odds(cycleEvents(pair.recorded).aortic_closes);
  return {withEndSystole(pair.played, played / (1 + played)),
          withEndSystole(pair.recorded, anchor)};
}

// The filling time in fractions.
struct Division {
  double rapid, diastasis, kick;
};

// A fast heart has no diastasis. With this minimum no two events of a beat coincide, and the map
// changes continuously between rates with and without diastasis. Our choice.
constexpr double kLeastDiastasis = 0.05;

Division divisionOf(const PhaseDurations& d) {
  const double share = d.diastasis_s / d.filling();
  if (share >= kLeastDiastasis)
    return {d.rapid_filling_s / d.filling(), share, d.atrial_kick_s / d.filling()};
  const double rest = (1 - kLeastDiastasis) / (d.rapid_filling_s + d.atrial_kick_s);
  return {rest * d.rapid_filling_s, kLeastDiastasis, rest * d.atrial_kick_s};
}

// Diastasis may be long in one beat and short in the other. Each beat adopts this fraction of the
// other's division, so no recorded part is skipped and no instant is frozen. Through each part of
// the filling the mean rate is then between 1/4 and 4 times that of the whole. Our choice.
constexpr double kTakenOver = 0.2;

PhaseDurations dividedAs(PhaseDurations d, const Division& own, const Division& other) {
  const double filling = d.filling();
  const auto part = [&](double share, double others) {
    return std::lerp(share, others, kTakenOver) * filling;
  };
  d.rapid_filling_s = part(own.rapid, other.rapid);
  d.diastasis_s = part(own.diastasis, other.diastasis);
  d.atrial_kick_s = part(own.kick, other.kick);
  return d;
}

void alignFilling(BeatPair& pair) {
  const Division played = divisionOf(pair.played), recorded = divisionOf(pair.recorded);
  pair.played = dividedAs(pair.played, played, recorded);
  pair.recorded = dividedAs(pair.recorded, recorded, played);
}

// Aortic opening and closing, mitral opening, start of diastasis and of the atrial kick, in s.
std::array<double, 5> eventTimes(const PhaseDurations& d) {
  const double filling_s = d.endSystole() + d.isovolumic_relaxation_s;
  const double diastasis_s = filling_s + d.rapid_filling_s;
  return {d.isovolumic_contraction_s, d.endSystole(), filling_s, diastasis_s,
          diastasis_s + d.diastasis_s};
}

}  // namespace

TimeWarp::TimeWarp(const RecordedBeat& recorded, double beat_s)
    : recorded_beat_s_(1 / recorded.heart_rate_hz) {
  CHECK_LT(0.0, beat_s);
  BeatPair pair = beatsOf(recorded, beat_s);
  end_systole_s_ = pair.played.endSystole();
  alignFilling(pair);
  const std::array<double, 5> played = eventTimes(pair.played), of = eventTimes(pair.recorded);
  for (std::size_t i = 0; i < played.size(); ++i) knots_[i + 1] = {played[i], of[i]};
  knots_.back() = {beat_s, recorded_beat_s_};
  setSlopes();
}

// Fritsch and Carlson, SIAM J. Numer. Anal. 17(2), 238-246, 1980: a cubic is monotone if both its
// slopes are at most three times the interval's mean. Within the beat: the weighted harmonic mean
// of Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5(2), 300-304, 1984, which satisfies this.
void TimeWarp::setSlopes() {
  const auto width = [&](std::size_t i) { return knots_[i + 1].time_s - knots_[i].time_s; };
  const auto mean = [&](std::size_t i) {
    return (knots_[i + 1].recorded_s - knots_[i].recorded_s) / width(i);
  };
  for (std::size_t i = 1; i + 1 < knots_.size(); ++i) {
    const double before = width(i) + 2 * width(i - 1), after = 2 * width(i) + width(i - 1);
    knots_[i].slope = (before + after) / (after / mean(i - 1) + before / mean(i));
  }
  // Real time at the R wave.
  knots_[0].slope = std::min(1.0, 3 * mean(0));
  knots_.back().slope = std::min(1.0, 3 * mean(knots_.size() - 2));
}

double TimeWarp::phaseAt(double time_s) const {
  std::size_t i = 0;
  while (i + 2 < knots_.size() && time_s >= knots_[i + 1].time_s) ++i;
  const Knot &a = knots_[i], &b = knots_[i + 1];
  const double width = b.time_s - a.time_s, rise = b.recorded_s - a.recorded_s;
  const double t = std::clamp((time_s - a.time_s) / width, 0.0, 1.0), u = 1 - t;
  // Hermite's cubic.
  const double recorded_s =
      a.recorded_s + rise * t * t * (3 - 2 * t) + width * t * u * (a.slope * u - b.slope * t);
  return std::clamp(recorded_s / recorded_beat_s_, 0.0, 1.0);
}

}  // namespace echocine
