#pragma once
// One counter for all stages of a job, so that the time left follows from its pace. It never falls.

#include <algorithm>
#include <cmath>

#include "core/monitor.h"

namespace echocine::fit {

// Units are about 0.1 s of one core; measured, rounded.
inline constexpr double kHeartUnits = 3;         // a computed heart
inline constexpr double kFamilyUnits = 0.8;      // a heart of a view
inline constexpr double kStartUnits = 2;         // a start in a view
inline constexpr double kEvaluationUnits = 0.3;  // a heart at a known pose in a view
inline constexpr double kOwnLoopUnits = 50;      // the rendered loops of a view
inline constexpr double kViewUnits = 40;         // a view of a ranking
inline constexpr double kUsualRounds = 6;        // of a descent

class FitProgress {
 public:
  FitProgress(const Monitor& monitor, double total) : monitor_(monitor), total_(total) {}

  // The monitor of the next stage, which takes so many units. It must not outlive this.
  Monitor next(double units) {
    Monitor one = monitor_;
    const double from = used_;
    used_ += units;
    one.tell = [this, from, units](const Progress& p) {
      const double share =
          p.total > 0 ? static_cast<double>(p.done) / static_cast<double>(p.total) : 0;
      tell(from + units * std::min(1.0, share));
    };
    return one;
  }
  double used() const { return used_; }  // units of all stages so far
  void finish() { tell(total_); }

 private:
  void tell(double units) {
    told_ = std::max(told_, std::min(units, total_));
    monitor_.tell({Task::settings, static_cast<std::size_t>(std::lround(told_)),
                   static_cast<std::size_t>(std::lround(total_))});
  }

  const Monitor& monitor_;
  double total_ = 0, used_ = 0, told_ = 0;
};

// Progress that goes on after so many units. The monitor must outlive the result.
inline Monitor monitorAfter(double units, const Monitor& monitor) {
  Monitor out = monitor;
  const auto before = static_cast<std::size_t>(std::lround(units));
  out.tell = [&monitor, before](const Progress& p) {
    monitor.tell({p.task, p.done + before, p.total + before});
  };
  return out;
}

// Units of a descent with so many unknowns of each view: six rounds, two of them with mixed
// derivatives.
inline double descentUnits(double views, double unknowns) {
  return views * kEvaluationUnits * (kUsualRounds * (5 + 2 * unknowns) + unknowns * (unknowns - 1));
}

}  // namespace echocine::fit
