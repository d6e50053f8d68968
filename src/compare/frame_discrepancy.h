#pragma once
// One number for optimisers: the discrepancy between synthetic and real frames.

#include <optional>
#include <span>
#include <vector>

#include "compare/wall_edges.h"
#include "echo/beam_grid.h"
#include "scene/probe.h"

namespace echocine::compare {

// (2)  D = 1 - c G,  0..2,
// with G of Eq. 1 (wall_edges.h) for the synthetic and the real frame over the sector, weighted by
// area. c is the overlap: the share of the original sector that both loops cover after
// registration, so an area without a partner counts as dissimilar. D is 0 for equal frames, about 1
// for an uninformative synthetic frame, and above 1 if edges are inverted. D of a loop is the mean
// over its frames. Displayed, log-compressed grey levels are compared without calibration: a
// calibration curve of frames that are not yet registered would flatten or invert the edges that
// register them.
inline double discrepancyOf(double edge_correlation, double overlap) {
  return 1 - overlap * edge_correlation;
}

// Built once from a real loop. Each call takes a synthetic frame in beam space as the tracer makes
// it (grey level 0 to 1 after log compression, line-major) and needs no file.
class FrameDiscrepancy {
 public:
  // The real loop is resampled to the lines of `probe` and to at most 384 of its depths.
  // `placement` maps beam space into the real picture, as Comparison::space does. Throws SceneError
  // if the sectors do not overlap or the loop has no scale.
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

// c of Eq. 2 from the areas before and after a placement of that scale.
double overlapShare(std::span<const float> weights_as_given, std::span<const float> weights,
                    double scale);

}  // namespace echocine::compare
