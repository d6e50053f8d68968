#pragma once
// The paper's arithmetic average over each point's neighbours, on intensities: as wide as the beam
// at that depth across the lines, as long as half the pulse along them.

#include <vector>

#include "core/beam_plane.h"
#include "scene/beam_profile.h"
#include "scene/scene.h"

namespace echocine {

class BeamAverage {
 public:
  BeamAverage(const Probe& probe, const SignalSettings& settings);

  // Averages a line-major plane in place. Windows end at the image's edges and keep their mean
  // there: a constant plane stays constant. The work is shared among threads; the result does not
  // depend on them.
  void apply(std::vector<float>& plane) const { apply(plane, {0, lines_}); }
  // The same of some lines; what becomes of the others is not defined.
  void apply(std::vector<float>& plane, LineRange lines) const;

  bool acrossLines() const { return !runs_.empty(); }
  // Of each line so many samples, from the first, as the averages of some lines take in.
  std::vector<int> taken(LineRange lines) const;

 private:
  // Samples first..last-1, neighbours in one block, whose windows end in the same lines: those of
  // line i in lines i + below and i + above.
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
  std::vector<float> taps_;             // axial weights, centre in the middle; empty: none
  std::vector<float> tap_sum_inverse_;  // per sample
  std::vector<Run> runs_;               // in order of samples; empty: no lateral average
  // Of each sample: half the window's width in lines, 1 / width, and the parts that the window
  // takes in of the lines at its ends.
  std::vector<double> half_;
  std::vector<float> scale_, part_below_, part_above_;
};

}  // namespace echocine
