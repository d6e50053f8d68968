#pragma once
// Grey levels that a model's tissues do not explain, measured in rendered loops of the model.

#include <cstddef>
#include <vector>

#include "fit/fit_terms.h"

namespace echocine::fit {

// A tissue has no single grey level: a wall along the beam is darker than one across it, and ribs
// and lung hide a part.
//
// (21)  e(t, n, x) = sum w r / (sum w + w_0)
// r: residual of Eq. 3 in loops of the model itself, in its SDs; w: share of tissue t in a cell as
// it is seen (SeenCells), times a Gaussian of its distance from x and weights 1 2 1 of the frames
// around n; w_0: kFewCells. The expected grey level of a cell is c d sum over t of f_t e(t, n, x).
// f_t: shares of the cell; d: SD of the residuals r' of the real loop; c: sum a e r' / sum a e^2
// over its cells of area a, within 0 and 1. c is 0 for a loop whose look differs altogether.
class ExpectedGreys {
 public:
  // None: a tissue has one grey level.
  ExpectedGreys() = default;
  // `maps`: of this model in loops of itself, at the identity pose.
  ExpectedGreys(const ModelLoop& model, const std::vector<FitMap>& maps);

  // Sets c and d from the map of this model, without expected greys, in a real loop. No change
  // without any.
  void scaleTo(const ModelLoop& model, const FitMap& real);

  // Sets TissueCell::expected. The model has the same tissues, frames and number of cells.
  void applyTo(ModelLoop& model) const;

  bool empty() const { return field_.empty(); }
  double shown() const { return shown_; }  // c

 private:
  // In SDs.
  double of(const TissueCell& cell, std::size_t frame, std::size_t number) const;

  std::size_t tissues_ = 0, frames_ = 0, cells_ = 0;
  std::vector<float> field_;  // e by tissue, frame and cell
  double shown_ = 0, deviation_ = 0;
};

}  // namespace echocine::fit
