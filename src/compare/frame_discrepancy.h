#pragma once
// One number for optimisers: how far synthetic frames are from real ones.

#include <optional>
#include <span>
#include <vector>

#include "compare/wall_edges.h"
#include "echo/beam_grid.h"
#include "scene/probe.h"

namespace echocine::compare {

// (2)  D = 1 - c G,  0..2,
// with G of Eq. 1 (wall_edges.h) for the synthetic and the real frame over the sector,
// area-weighted, and c the share of the sector, as the loops were given, that registration leaves
// in both: what it moves out of sight counts as unlike. 0 for equal frames, about 1 when the
// synthetic frame says nothing of the real one, above 1 when it is dark where the real one is
// bright. The loop's number is the mean over its frames. Greys are compared as they are displayed,
// both log-compressed. No calibration comes before: a curve fitted to frames that do not yet lie on
// one another flattens the very edges that would bring them there, and may turn them round.
inline double discrepancyOf(double edge_correlation, double overlap) {
  return 1 - overlap * edge_correlation;
}

// Built once from a real loop; each call takes a synthetic frame in beam space as the tracer makes
// it (grey 0 to 1 after log compression, line-major) and needs no file.
class FrameDiscrepancy {
 public:
  // The real loop is resampled to the lines of `probe` and to at most 384 of its depths.
  // `placement`: of beam space in the real picture, such as Comparison::space found it. Throws
  // SceneError when the sectors do not overlap or the loop has no scale.
  FrameDiscrepancy(const echo::EchoLoop& real, const Probe& probe,
                   const echo::Placement& placement = {});

  int realFrames() const { return static_cast<int>(real_.size()); }
  double overlapShare() const { return overlap_; }

  // Thread-safe.
  double operator()(int frame, std::span<const float> grey) const;

 private:
  Probe probe_;
  echo::BeamGrid grid_;
  int per_sample_ = 1;
  double overlap_ = 1;
  std::optional<WallEdges> edges_;
  std::vector<EdgeField> real_;
};

// c of Eq. 2 for areas before and after a placement of that scale.
double overlapShare(std::span<const float> weights_as_given, std::span<const float> weights,
                    double scale);

}  // namespace echocine::compare
