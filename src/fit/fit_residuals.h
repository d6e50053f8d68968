#pragma once
// The discrepancy as a vector of residuals, for least-squares optimisers.

#include <functional>
#include <vector>

#include "fit/boundary_sides.h"
#include "fit/model_discrepancy.h"

namespace echocine::fit {

// (18)  r . r = 1 + D,   D of Eq. 6
// The residuals, in this order, for a model of F frames, C cells a frame and S structures:
//   F C            sqrt(c w_R a / (W S_tot)) (g - g'), the grey g of a cell of area a seen, minus
//                  that g' of its tissues, the gain (Eq. 3) and what is expected (Eq. 21), frame by
//                  frame;
//   3 F S kSides   for each frame and structure, kSides directions from the middle of its boundary:
//                  the mean signed distance of the edges (Eq. 4), then both components of the mean
//                  of u - v (Eq. 5), times square roots of their weights;
//   1              the square root of the rest of 1 + D: spread within the directions, area out
//                  of the sector. It is about 1 and changes little.
// W: w_R + w_B + w_M; c: overlap. Their number depends on F, C and S only, so that models of other
// dials are comparable residual by residual. Pieces of boundary count for the two nearest
// directions by linear shares, so residuals are continuous.

// D at one pose as residuals. Throws SceneError like checkPose(). Thread-safe.
std::vector<double> residualsOf(const ModelDiscrepancy& discrepancy, const ModelLoop& model,
                                const FitPose& pose);

struct ResidualColumns {
  std::vector<double> values;                // r
  std::vector<std::vector<double>> columns;  // dr/du by unknown: the model's, then the pose's
};

// Any model with unknowns, such as dials or shape coefficients. Thread-safe.
using ModelOfUnknowns = std::function<ModelLoop(const std::vector<double>&)>;

// Steps of the pose's columns: shift_x and shift_z in m, turn in rad, scale. Our choice: half a
// millimetre is a third of a cell.
inline constexpr double kShiftStep_m = 5e-4, kTurnStep_rad = 0.01, kScaleStep = 0.005;

// Residuals with the columns of all unknowns of the model, and of shift_x, shift_z, turn and scale
// of the pose. Columns are central differences over two steps: tissues of cells change in steps of
// an eighth of a cell, so a derivative of zero width does not exist. Runs in parallel. Throws
// SceneError for a step that is not positive, and like residualsOf().
ResidualColumns residualColumns(const ModelDiscrepancy& discrepancy, const ModelOfUnknowns& model,
                                const std::vector<double>& at, const std::vector<double>& steps,
                                const FitPose& pose);

}  // namespace echocine::fit
