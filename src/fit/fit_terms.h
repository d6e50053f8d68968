#pragma once
// How far a model is from a real loop, term by term.

#include <array>
#include <span>
#include <vector>

#include "echo/echo_stack.h"
#include "fit/model_plane.h"

namespace echocine::fit {

// Where the model's plane lies in the real one: a point p of the model is seen at
//   middle + shift + scale R(turn) (p - middle),
// the middle being half the model's depth below its apex, so that a turn hardly shifts.
// Frame n of the model is held against picture n + lag of the real beat, its phase run through so
// that the model's end-systole meets that of the pictures (warpedPhase()).
struct FitPose {
  double shift_x_m = 0, shift_z_m = 0, turn_rad = 0, scale = 1;
  int lag = 0;         // pictures
  double systole = 0;  // where end-systole is in the pictures; 0: where the stack has it
};

// What is looked at: every `picture`-th frame, every `cell`-th cell each way, every `piece`-th
// piece of boundary.
struct FitStride {
  int picture = 1, cell = 1, piece = 1;
};

// The terms; each 0 for a perfect model, about 1 for one that says nothing.
struct FitTerms {
  double region = 1, boundary = 1, motion = 1;
  double overlap = 0;  // share of the model's plane that the real sector shows
};

// Weights of the terms in D. Our choice, looked at on synthetic pairs of known truth (README.md),
// never on real videos.
struct FitWeights {
  double region = 0.5, boundary = 0.3, motion = 0.2;
};

// (6)  D = c (w_R R + w_B B + w_M M) / (w_R + w_B + w_M) + 1 - c,   c: share in sight.
double fitDiscrepancy(const FitTerms& terms, const FitWeights& weights = {});

// (3)  R = residual / total sum of squares,
// both of the real greys over all cells of the beat, by area: the total one after the best gain
// over depth, the residual one after the best gain over depth and grey for each tissue together
// (analysis of covariance; 1 - R is the correlation ratio of Pearson and of Roche et al., MICCAI
// 1998, for cells that two tissues share). Gain is continuous, linear between four depths. Blood
// is given no brighter grey than any other tissue: it scatters 20 to 30 dB less, and no display
// turns that round. A boundary of blood is seen beside itself by what the loop spreads echoes
// (Eq. 9 of echo_spread.h): what lies between is counted as the tissue beside the blood.
//
// (4)  B = < sum_s p(s) (s/S)^2 > / < (s/S)^2 >,   p(s) = exp(2 e(s)/E) / sum exp(2 e(s)/E),
// mean over pieces of boundary of blood by length: other boundaries have edges of no known sign,
// and are no claim of a heart's model. e(s): gradient of the real grey along the normal at s from
// where the boundary is seen (Eq. 9), out of blood; E: root mean square of the gradient over the
// loop; S: 8 mm, in 9 steps. 1 where the loop shows no edge, near 0 where all edges lie on the
// boundary, up to 2.4 where they lie elsewhere. Maps show the others too, by the magnitude of the
// gradient.
//
// (5)  M = sum w |u - v|^2 / sum w (|u|^2 + |v|^2),
// u the model's displacement from frame to frame, v what block matching finds 2 mm outside the
// blood there, w the length of the piece times the correlation of the blocks. Of boundaries of
// blood. 0 for equal, 1 for unrelated, 2 for opposite motion.
FitTerms fitTerms(const ModelLoop& model, const echo::EchoStack& real, const FitPose& pose,
                  const FitStride& stride = {});
// Of several poses: each picture is read while it is near at hand.
std::vector<FitTerms> fitTerms(const ModelLoop& model, const echo::EchoStack& real,
                               std::span<const FitPose> poses, const FitStride& stride);

// Where the model disagrees: the same as the terms, place by place.
struct BoundaryOffset {
  float x_m = 0, z_m = 0;  // in the real plane
  float offset_mm = 0;  // of the edges about where it is to be seen, along its normal: sum p(s) s
  float certainty = 0;  // 0 no edge to be seen, 1 a single one
  float motion_mm = 0;  // |u - v|; negative where nothing was tracked
  std::uint16_t surface = 0;
  std::uint8_t segment = 0;  // of the left ventricle's wall; 0: none
};
// What the tissues leave of the real grey in a cell, in standard deviations.
struct RegionLeft {
  float x_m = 0, z_m = 0;  // in the real plane
  float left = 0;
};
struct FitMap {
  std::vector<std::vector<BoundaryOffset>> boundary;  // by frame
  std::vector<std::vector<RegionLeft>> region;        // by frame: cells near blood and in sight
  std::vector<double> tissue_grey;                    // by tissue
};
FitMap fitMap(const ModelLoop& model, const echo::EchoStack& real, const FitPose& pose);

// How far edges lie from a part of the boundaries over the beat; means by certainty, not a number
// where nothing is seen. Out of blood is positive: the model's chamber is too small there.
struct OffsetCurve {
  std::size_t part = 0;                        // a structure, or a segment of 1 to 17
  std::vector<double> offset_mm, distance_mm;  // by frame: of the offsets, of their sizes
  std::vector<double> motion_mm;               // of |u - v|, even mean
};
// Of structures that show a boundary, and of segments of the left ventricle's wall that do.
std::vector<OffsetCurve> offsetCurves(const FitMap& map, std::size_t structures);
std::vector<OffsetCurve> segmentCurves(const FitMap& map);

}  // namespace echocine::fit
