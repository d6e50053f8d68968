#pragma once
// Spatial registration of two loops after their sectors: estimated from the echoes.

#include <functional>
#include <string>
#include <vector>

#include "echo/resample.h"
#include "fit/descent.h"

namespace echocine::compare {

// Limits of the search for other people's hearts under similar probe positions. Our choice. The
// scale is fixed if both loops have one; otherwise sectors are first assumed to have the same
// depth.
inline constexpr double kMostShift = 0.15;    // of the real sector's outer radius, each way
inline constexpr double kMostTurn_deg = 10;   // about the apex, each way
inline constexpr double kMostScaling = 0.15;  // each way

struct PlacementFound {
  echo::Placement placement;
  double unlike = 1;  // E of Eq. 7
};

struct SpaceAlignment {
  echo::Placement placement;                    // of beam space in the real picture
  std::string method = "unregistered sectors";  // or "several starts, then Newton's method"
  bool used = false;                            // false: no placement is better
  bool at_limit = false;  // the best placement is at a limit and may lie beyond
  double unlike = 1;      // E of Eq. 7
  // Eq. 8 of descent.h with the baseline 1.
  double confidence = 0;
  // Other optima in ascending order, more than 7 % of the radius or 10 degrees from the best.
  std::vector<PlacementFound> rivals;
};

// The placement that minimises
// (7)  E = (1 - G) / c,
// with G the mean of Eq. 1 over pairs of frames and c the overlap of Eq. 2. E is 0 for perfect
// agreement of edges, for any overlap. D = 1 - c G is biased towards poses with more overlap; E is
// not. c is at least one half within the limits.
//
// One method for all loops. All placements of a lattice (4 % of the radius, 5 degrees, 7.5 % of
// scale) are evaluated with the loops' means, which need no pairing in time. starts() refines the
// best five separate ones and the unregistered sectors by Newton's method. refined() continues from
// each with a dozen frames that are paired in time. E is measured on at most 96 x 96 samples. Their
// weights fall evenly to 0 at the edge of the real sector, so E has no steps.
class SpaceSearch {
 public:
  // References are kept.
  SpaceSearch(const echo::BeamGrid& grid, const echo::EchoLoop& synthetic,
              const echo::EchoLoop& real);

  // Placements as unknowns of this search. Runs in parallel.
  std::vector<fit::Unknowns> starts() const;
  echo::Placement placementAt(const fit::Unknowns& at) const;

  // `synthetic_at`: the instant of the synthetic loop that a real frame shows, blended on a grid;
  // empty if it shows none.
  using Pairing =
      std::function<std::vector<float>(const std::vector<std::vector<float>>&, std::size_t real)>;
  fit::Descent refined(const fit::Unknowns& start, const Pairing& synthetic_at) const;

  // The best of the refined starts.
  SpaceAlignment best(const std::vector<fit::Descent>& refined) const;

 private:
  struct Pair {
    std::vector<float> synthetic;    // on the grid
    const std::vector<float>* real;  // a picture of the sampler
  };
  double unlikeAt(const std::vector<Pair>& pairs, const fit::Unknowns& at) const;
  std::vector<float> weightsAt(const std::vector<echo::PixelPlace>& in_loop) const;
  fit::SearchBox box() const;

  echo::BeamGrid grid_;
  const echo::EchoLoop& real_;
  echo::LoopSampler sampler_;
  echo::BeamLoop synthetic_;
  std::vector<float> inside_;  // of the real picture: 1 where it shows echo
  std::vector<float> as_given_;
  std::vector<std::size_t> frames_;           // frames of the real loop that are evaluated
  std::vector<std::vector<float>> pictures_;  // their pictures
};

}  // namespace echocine::compare
