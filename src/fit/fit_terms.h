#pragma once
// The discrepancy between a model and a real loop, term by term.

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "echo/echo_stack.h"
#include "fit/model_plane.h"

namespace echocine::fit {

// Pose of the model's plane in the real plane. A point p of the model is seen at
//   middle + shift + scale R(turn) (p - middle),
// where `middle` is half the model's depth below its apex, so that a rotation causes little shift.
// Frame n of the model is compared with picture n + lag of the real beat. The phase is warped so
// that the model's end-systole meets that of the pictures (warpedPhase()).
struct FitPose {
  double shift_x_m = 0, shift_z_m = 0, turn_rad = 0, scale = 1;
  int lag = 0;         // pictures
  double systole = 0;  // end-systole in the pictures; 0: that of the stack
};

// Subsampling: every `picture`-th frame, every `cell`-th cell each way, every `piece`-th piece of
// boundary.
struct FitStride {
  int picture = 1, cell = 1, piece = 1;
};

// The terms: 0 for a perfect model, about 1 for an uninformative one.
struct FitTerms {
  double region = 1, boundary = 1, motion = 1;
  double overlap = 0;  // share of the model's plane that the real sector shows
};

// Weights of the terms in D. Our choice, from synthetic pairs of known truth (tests/bench/fit),
// never from real videos.
struct FitWeights {
  double region = 0.5, boundary = 0.3, motion = 0.2;
};

// (6)  D = c (w_R R + w_B B + w_M M) / (w_R + w_B + w_M) + 1 - c,   c: overlap.
double fitDiscrepancy(const FitTerms& terms, const FitWeights& weights = {});

// Cells and boundaries also have the weights of the model's Focus, in all terms.
//
// (3)  R = residual / total sum of squares
// of the real grey levels over all cells of the beat, weighted by area. The total is that after the
// best gain over depth. The residual is that after a joint fit of the gain over depth and one grey
// level per tissue (analysis of covariance; 1 - R is the correlation ratio of Pearson and of Roche
// et al., MICCAI 1998, extended to cells of two tissues). The gain is continuous and linear between
// four depths. Blood never gets a brighter grey level than another tissue: it scatters 20 to 30 dB
// less, and no display inverts that. A boundary of blood is visible displaced by the loop's spread
// of echoes (Eq. 9 of echo_spread.h), in a fit farther (kInside_m). The strip between counts as the
// tissue beside the blood (SeenCells). Expected grey levels of cells (Eq. 21) are subtracted for
// the residual, not for the total.
//
// (4)  B = < sum_s p(s) (s/S)^2 > / < (s/S)^2 >,   p(s) = exp(2 e(s)/E) / sum exp(2 e(s)/E)
// is the mean over pieces of blood boundary, by length. Pieces with a second edge before them count
// less (second_edges.h). Other boundaries have edges of unknown sign and are not used. e(s) is the
// gradient of the real grey level along the normal, out of blood, at a distance s from the expected
// visible position (seenBeside()). E is the root mean square of the gradient over the loop; S is 8
// mm, in 9 steps. B is 1 if the loop shows no edge, near 0 if all edges lie on the boundary, and up
// to 2.4 if they lie elsewhere. Maps also show the other boundaries, by the magnitude of the
// gradient.
//
// (5)  M = sum w |u - v|^2 / sum w (|u|^2 + |v|^2)
// over boundaries of blood. u is the model's displacement between frames, v that of block matching
// 2 mm outside the blood, and w the length of the piece times the correlation of the blocks. M is 0
// for equal, 1 for unrelated, 2 for opposite motion.
FitTerms fitTerms(const ModelLoop& model, const echo::EchoStack& real, const FitPose& pose,
                  const FitStride& stride = {});

class SeenCells;

// A model's frames at their instants of a loop: what poses of one time share. References to the
// loop's pictures are kept.
class PlacedBeat {
 public:
  // The time of a pose: its `lag` and `systole`.
  PlacedBeat(const ModelLoop& model, const echo::EchoStack& real, const FitPose& time,
             const FitStride& stride = {});

  // Blends the pictures of each instant once: worth it for ten poses or more.
  void blend();

  // Thread-safe. Each picture is read once for all poses, which have the beat's time.
  std::vector<FitTerms> terms(std::span<const FitPose> poses) const;

 private:
  struct Frame {
    echo::EchoInstant at;
    std::vector<TissueCell> cells;
    std::vector<int> number;              // of a cell, as in SeenCells
    std::vector<BoundaryPoint> boundary;  // of blood
    std::vector<double> angles_rad;       // of the boundary, as in SeenCells
  };
  std::vector<Frame> frames_;
  std::vector<bool> blood_;
  double far_m_;
  std::shared_ptr<const SeenCells> seen_;  // without cells
};

// The disagreement of the model: the terms, place by place.
struct BoundaryOffset {
  float x_m = 0, z_m = 0;  // in the real plane
  float offset_mm =
      0;  // mean position of the edges relative to the expected one, along its normal: sum p(s) s
  float certainty = 0;  // 0 no visible edge, 1 a single one
  float motion_mm = 0;  // |u - v|; negative without tracking
  std::uint16_t surface = 0;
  std::uint8_t segment = 0;  // of the left ventricle's wall; 0: none
  bool of_blood = false;     // blood on exactly one side
  std::uint32_t piece = 0;   // of the model's frame
};
// Residual of the real grey level in a cell, in standard deviations.
struct RegionLeft {
  float x_m = 0, z_m = 0;  // in the real plane
  float left = 0;
  std::uint32_t cell = 0;              // of the model's frame
  std::uint8_t first = 0, second = 0;  // tissues of the cell as it is seen (SeenCells)
  float share = 1;                     // share of the first
};
struct FitMap {
  std::vector<std::vector<BoundaryOffset>> boundary;  // by frame
  std::vector<std::vector<RegionLeft>> region;        // by frame: visible cells near blood
  std::vector<double> tissue_grey;                    // by tissue
  double deviation = 0;                               // SD of the residual grey level
};
FitMap fitMap(const ModelLoop& model, const echo::EchoStack& real, const FitPose& pose);

// Distance of edges from a part of the boundaries over the beat. Means are weighted by certainty;
// NaN if nothing is visible. Positive is out of blood: the model's chamber is too small there.
struct OffsetCurve {
  std::size_t part = 0;                        // a structure, or a segment of 1 to 17
  std::vector<double> offset_mm, distance_mm;  // by frame: mean offset, mean absolute offset
  std::vector<double> motion_mm;               // mean of |u - v|, unweighted
  double pieces = 0, certainty = 0;  // of the boundary, a frame; mean certainty of a piece
};
// Curves of structures with a visible boundary, and of such segments of the left ventricle's wall.
std::vector<OffsetCurve> offsetCurves(const FitMap& map, std::size_t structures);
std::vector<OffsetCurve> segmentCurves(const FitMap& map);

}  // namespace echocine::fit
