#pragma once
// What is left between two loops in space once their sectors lie on one another: found from the
// echoes themselves.

#include <functional>
#include <string>
#include <vector>

#include "echo/resample.h"
#include "fit/descent.h"

namespace echocine::compare {

// Limits of the search, our choice: how far hearts lie from where others do under a probe held
// alike. The scale stays where both loops have one; else sectors are first taken to be of one
// depth.
inline constexpr double kMostShift = 0.15;    // of the real sector's outer radius, each way
inline constexpr double kMostTurn_deg = 10;   // about the apex, each way
inline constexpr double kMostScaling = 0.15;  // each way

struct PlacementFound {
  echo::Placement placement;
  double unlike = 1;  // E of Eq. 7
};

struct SpaceAlignment {
  echo::Placement placement;                   // of beam space in the real picture
  std::string method = "sectors as they are";  // or "several starts, then Newton's method"
  bool used = false;                           // false: nothing else is better
  bool at_limit = false;                       // of what the search may do: the best may lie beyond
  double unlike = 1;                           // E of Eq. 7
  // Eq. 8 of descent.h; what says nothing has an E of 1.
  double confidence = 0;
  // Other optima, least first: farther than 7 % of the radius or 10 degrees from the best.
  std::vector<PlacementFound> rivals;
};

// The placement of least
// (7)  E = (1 - G) / c,
// G the mean of Eq. 1 over pairs of frames, c the share in sight of Eq. 2: what is unlike, per what
// is in sight. Where edges agree wholly it is 0 whatever leaves the sight. D = 1 - c G is not: its
// least value lies off the right place, towards more in sight. c is half at least within the
// limits.
//
// One method, however alike the loops are. All placements of a lattice (4 % of the radius, 5
// degrees, 7.5 % of scale) are tried with the loops' means, which need no pairing in time. Newton's
// method leads on from the best five that stand apart and from the sectors as they are: starts().
// From each of these it leads on with a dozen frames that are paired in time: refined(). E is
// measured on at most 96 x 96 samples, whose weights fall evenly to nothing where the real sector
// ends: it has no steps.
class SpaceSearch {
 public:
  // References are kept.
  SpaceSearch(const echo::BeamGrid& grid, const echo::EchoLoop& synthetic,
              const echo::EchoLoop& real);

  // Places in unknowns of this search. Runs in parallel.
  std::vector<fit::Unknowns> starts() const;
  echo::Placement placementAt(const fit::Unknowns& at) const;

  // `synthetic_at`: the instant of the synthetic loop that a real frame shows, made of its frames
  // on a grid; nothing where it shows none.
  using Pairing =
      std::function<std::vector<float>(const std::vector<std::vector<float>>&, std::size_t real)>;
  fit::Descent refined(const fit::Unknowns& start, const Pairing& synthetic_at) const;

  // Of what was refined.
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
  std::vector<float> inside_;  // the real picture: 1 where it shows echo
  std::vector<float> as_given_;
  std::vector<std::size_t> frames_;           // of the real loop, that are looked at
  std::vector<std::vector<float>> pictures_;  // of them
};

}  // namespace echocine::compare
