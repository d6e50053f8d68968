#pragma once
// Volume of a ventricle over the beat, as a fraction of its stroke volume.

#include <optional>

#include "motion/cycle/cardiac_timing.h"

namespace echocine {

class VolumeCurve {
 public:
  // `kick_share`: fraction of the stroke volume filled by the atrial kick, in (0, 1); default:
  // healthy.
  explicit VolumeCurve(const PhaseDurations& durations, std::optional<double> kick_share = {});

  // Filled fraction at a phase in [0, 1]: 1 at end-diastole, 0 at end-systole; volume = ESV +
  // fraction (EDV - ESV). Constant in the isovolumic phases, falling in ejection, rising in
  // filling; once continuously differentiable, also between beats.
  double at(double phase) const;

  // Fractions of the stroke volume filled during rapid filling and the atrial kick.
  double rapidShare() const { return 1 - diastasis_share_ - kick_share_; }
  double kickShare() const { return kick_share_; }

 private:
  CycleEvents events_;
  double diastasis_share_ = 0, kick_share_ = 0;
  double diastasis_slope_ = 0;  // fraction of the stroke volume per beat
};

}  // namespace echocine
