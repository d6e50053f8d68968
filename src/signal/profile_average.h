#pragma once
// Average across the lines over the sampled two-way beam (scene/sampled_beam.h), side lobes
// included:
//
//   I'_i(z) = sum_j w_ij(z) I_j(z) / sum_j w_ij(z)                                        (B3)
//   w_ij(z) = integral of P(u, q_i(z)) over the u between line j's borders                (B4)
//
// Lines within the main lobe enter one by one, those beyond it as means of a few neighbours. Sums
// end at the sector's edges, so a constant plane stays constant. From 513 lines on, rows of
// neighbours stand for lines, and results are interpolated between rows.

#include <memory>
#include <vector>

#include "core/beam_plane.h"
#include "core/lanes.h"
#include "signal/profile_windows.h"

namespace echocine {

enum class BeamPart { whole, main_lobe };

class ProfileAverage {
 public:
  // Precondition: at least two lines.
  ProfileAverage(const Probe& probe, const BeamPulse& pulse);

  // Averages the lines of a line-major plane in place; reads all lines. The main lobe alone has the
  // same weights, without those of the side lobes; it is for planes of few echoes. Runs in
  // parallel; the result does not depend on the threads.
  void apply(std::vector<float>& plane, LineRange lines, BeamPart part = BeamPart::whole) const;

 private:
  struct Slab;

  void read(const float* plane, Slab& slab) const;
  void findEchoing(const Floats8* rows, Slab& slab) const;
  void findGroups(const Floats8* rows, Slab& slab) const;
  void averageVector(int vector, LineRange lines, BeamPart part, Slab& slab) const;
  Floats8 averageAll(const ProfileWindows::Window& window, const Floats8* rows,
                     const Slab& slab) const;
  Floats8 averageEchoing(const ProfileWindows::Window& window, const Floats8* rows,
                         const Slab& slab) const;
  void write(const Slab& slab, LineRange lines, float* plane) const;

  int lines_, samples_;
  std::shared_ptr<const ProfileWindows> shared_;
  const ProfileWindows& windows_;
};

}  // namespace echocine
