#pragma once
// The paper's arithmetic average over neighbouring samples, of intensities: as wide as the beam at
// that depth across the lines, and half a pulse long along them.

#include <vector>

#include "core/beam_plane.h"
#include "scene/beam_profile.h"
#include "scene/scene.h"

namespace echocine {

class BeamAverage {
 public:
  // most_half_lines: bounds half the width of a window, in lines; 0: twice the image.
  BeamAverage(const Probe& probe, const SignalSettings& settings, double most_half_lines = 0);

  // Averages a line-major plane in place. Windows are cut at the image's edges and renormalised: a
  // constant plane stays constant. Runs in parallel; the result does not depend on the threads.
  void apply(std::vector<float>& plane) const { apply(plane, {0, lines_}); }
  // The same for some lines; the content of the others is undefined.
  void apply(std::vector<float>& plane, LineRange lines) const;

  bool acrossLines() const { return !runs_.empty(); }
  // Number of samples of each line, from the first, that the averages of some lines need.
  std::vector<int> taken(LineRange lines) const;

 private:
  // Adjacent samples first..last-1 in one block whose windows end at the same lines: for line i, at
  // lines i + below and i + above.
  struct Run {
    int first, last, below, above;
  };
  struct Workspace;
  struct Borders;
  Borders bordersOf(const std::vector<float>& plane) const;
  void prepareLateral(const std::vector<double>& half_width_lines);
  void averageAlong(const float* plane, int line, int first, int count, const Borders& borders,
                    Workspace& w) const;
  void averageAcross(int line, const Run& run, int block_first, Workspace& w, float* out) const;
  void averageBlock(float* plane, LineRange lines, int first, int count, const Borders& borders,
                    Workspace& w) const;

  int lines_ = 0, samples_ = 0;
  std::vector<float> taps_;             // axial weights, the centre in the middle; empty: none
  std::vector<float> tap_sum_inverse_;  // per sample
  std::vector<Run> runs_;               // in order of samples; empty: no lateral average
  // For each sample: half the width of the window in lines, 1 / width, and the fractions of the
  // outermost lines within the window.
  std::vector<double> half_;
  std::vector<float> scale_, part_below_, part_above_;
};

}  // namespace echocine
