#pragma once
// Where the edges of a model are visible: measured in rendered loops of the model itself.

#include <cstddef>
#include <vector>

#include "fit/boundary_sides.h"
#include "fit/fit_terms.h"

namespace echocine::fit {

// Distances from the boundaries of blood at which their edges are visible, beyond Eq. 9 and
// Focus::left_ventricle. They differ from place to place: trabeculae, papillary muscles, leaflets,
// oblique walls and the thickness of the slice move edges, and the labels of a model do not.
//
// (20)  o(k, n, a) = sum w s / (sum w + w_0),   distance of a piece of boundary: q o(k, n, a)
// s: mean offset of the edges of a piece (Eq. 4) in loops of the model itself, positive out of
// blood; w: their certainty, with weights 1 2 1 of the frames around n and of the kSides directions
// around a; w_0: kFewPieces; k, n, a: structure, frame and direction. Rounds of add() sum up, to
// 4 mm at most. q: slope of the offsets in the real loop over o of the first round, within 0 and 1:
// both are means of p(s), which show a part of a displacement. q is 0 for a loop whose edges
// deviate from their means in another way.
class ExpectedEdges {
 public:
  // Without any: models keep their edges.
  ExpectedEdges() = default;
  ExpectedEdges(std::size_t frames, std::size_t structures);

  // Adds to the distances what is left of them: the mean offset of the edges in `maps`, by
  // structure, direction and frame. Each map is of this model, with these edges, in a loop of the
  // model at the identity pose.
  void add(const ModelLoop& model, const std::vector<FitMap>& maps);

  // Sets q from the map of this model, without expected edges, in a real loop at a pose of this
  // scale. A fit moves the mean offset of a structure to 0, so only deviations from these means
  // count. No change without any distances.
  void scaleTo(const ModelLoop& model, const FitMap& real, double scale = 1);

  // Subtracts the distances from BoundaryPoint::inside_m. Continuous in the places of the pieces.
  void applyTo(ModelLoop& model) const;

  double shown() const { return shown_; }  // q

 private:
  using Distances = std::vector<double>;  // m, by frame, structure and direction
  double at(const Distances& distances, const BoundaryPoint& piece, const BoundaryMiddle& middle,
            std::size_t frame) const;

  std::size_t frames_ = 0, structures_ = 0;
  double shown_ = 0;
  Distances outside_m_, first_m_;  // of all rounds, of the first one
};

}  // namespace echocine::fit
