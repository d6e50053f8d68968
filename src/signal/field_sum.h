#pragma once
// The envelope of echoes, clutter and noise together.
//
// With the field A of the echoes and its mean power Ibar, and fields c and n of mean power C and N:
//   I = (Ibar + C + N) smooth(|A + c + n|^2 / (Ibar + C + N)),
// so the mean is Ibar + C + N. Without smoothing the sum of speckle and noise is Rayleigh
// distributed, as each of them is. Without speckle the echoes have no phase: the picture is their
// mean, and clutter and noise are an intensity of their own, I = Ibar + (C + N) smooth(...).
// The mean over seeds of clutter and noise (plan.averaged) is I + C + N.

#include <optional>
#include <span>
#include <vector>

#include "core/beam_plane.h"
#include "plan/effect_plan.h"
#include "signal/noise.h"
#include "speckle/line_smoothing.h"
#include "trace/echo_field.h"

namespace echocine {

class FieldSum {
 public:
  // Without clutter and noise it adds nothing.
  FieldSum(const Scene& scene, const EffectPlan& plan, std::span<const float> gains);

  bool adds() const { return !levels_.empty(); }
  // True if add() draws fields, and so needs that of the echoes.
  bool draws() const { return clutter_ || noise_; }

  // Intensities relative to the transmitted one, in place. field: that of the same intensities, or
  // empty without speckle. Runs in parallel; the result does not depend on the threads.
  void add(double white, double time_s, const EchoField& field, std::span<float> intensities) const;

  // Adds clutter and noise to the field of echoes with speckle, for some lines; its mean stays that
  // of the echoes. Runs in parallel, as add().
  void addTo(EchoField& field, double white, double time_s, LineRange lines) const;

 private:
  struct Line;

  void addDrawn(double white, double time_s, int number, float* real, float* imaginary) const;
  void addMean(double white, std::span<float> intensities) const;
  void addLine(double white, double time_s, int number, const EchoField& field, Line& line,
               std::span<float> intensities) const;

  int lines_, samples_;
  std::optional<NearFieldClutter> clutter_;
  std::optional<ReceiverNoise> noise_;
  std::vector<float> levels_;  // mean power of both over white; empty without them
  LineSmoothing smoothing_;
};

}  // namespace echocine
