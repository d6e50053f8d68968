#pragma once
// How full a ventricle is over the beat, as a share of its stroke volume.

#include <optional>

#include "motion/cycle/cardiac_timing.h"

namespace echocine {

class VolumeCurve {
 public:
  // `kick_share`: part of the stroke volume that the atrial kick fills, in (0, 1); else as in
  // health.
  explicit VolumeCurve(const PhaseDurations& durations, std::optional<double> kick_share = {});

  // Filled share at a phase in [0, 1]: 1 at end-diastole, 0 at end-systole; volume is then
  // ESV + share (EDV - ESV). Constant in the isovolumic phases, falling in ejection, rising in
  // filling; continuous with its first derivative, also from one beat to the next.
  double at(double phase) const;

  // Parts of the stroke volume that come in during rapid filling, diastasis and the atrial kick.
  double rapidShare() const { return 1 - diastasis_share_ - kick_share_; }
  double diastasisShare() const { return diastasis_share_; }
  double kickShare() const { return kick_share_; }

 private:
  CycleEvents events_;
  double diastasis_share_ = 0, kick_share_ = 0;
  double diastasis_slope_ = 0;  // share of the stroke volume per beat
};

}  // namespace echocine
