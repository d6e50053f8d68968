#pragma once
// The cost of a heart in one to three views: one function for starts, steps, stop and intervals.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fit/expected_edges.h"
#include "fit/expected_greys.h"
#include "fit/expected_slope.h"
#include "fit/fit_journal.h"
#include "fit/heart_family.h"
#include "fit/heart_prior.h"
#include "fit/quadratic.h"

namespace echocine::fit {

// A dial, or the tilt or rotation of a view's plane in degrees.
struct FitUnknown {
  std::string name;
  double low = 0, high = 0;
  // For differences: J rises by several units, well above its noise of 0.5 (D changes by 0.0004
  // with the refined pose).
  double step = 1;
  bool held = false;  // stays where it is
};

struct FitPlace {
  std::vector<double> at;        // by unknown
  std::vector<PoseFound> found;  // by view
  double cost = 0;
};

// How far a loop deviates from the labels of a heart as the heart's own rendered loops do: q of
// Eq. 20 and c of Eq. 21.
struct OwnSight {
  double edges = 0, greys = 0;

  double both() const { return edges * greys; }
};

// Deviations that own loops of a heart show beyond its tissues and their boundaries.
struct ExpectedLook {
  ExpectedEdges edges;
  ExpectedGreys greys;
  ExpectedSlope slope;

  // None without own loops.
  std::optional<OwnSight> sight() const {
    if (greys.empty()) return std::nullopt;
    return OwnSight{edges.shown(), greys.shown()};
  }

  void applyTo(ModelLoop& model) const {
    edges.applyTo(model);
    greys.applyTo(model);
  }
};

// A loop's model and its comparison, which must outlive the cost.
struct FitSide {
  const HeartFamily* family;
  const ModelDiscrepancy* discrepancy;
  const ExpectedLook* look;

  // With Focus::left_ventricle and the expected look.
  ModelLoop modelAt(const std::vector<double>& values, const PlaneTilt& tilt) const;
};

// Independent samples of a loop in Eq. 14. Our choice: with 200, the prior moved EF of planted
// hearts by up to 0.02.
inline constexpr double kLoopSamples = 1000;
// SD of tilt and rotation of a plane about its view. Our choice: planes of the same view by
// different people are a few degrees apart.
inline constexpr double kTiltSd_deg = 4, kRotateSd_deg = 5;

// A view's part of J, without its plane, for D or D' (Eq. 24).
double viewCostOf(double discrepancy);

// (14)  J = sum over views of N/2 ln D + (tilt/4)^2/2 + (rotate/5)^2/2,  minus ln p(dials)
// with D at the pose of lowest D. If D is a share of variance, N/2 ln D is minus the log-likelihood
// of N independent samples of unknown variance. N: kLoopSamples; p: HeartPrior.
class FitCost {
 public:
  // `dials`: fixed ones. `tilt_deg`: limit of tilt and rotation; 0: not unknown. Precondition: all
  // families have the same ranges. Evaluations that the memory has are not repeated.
  FitCost(std::vector<FitSide> sides, const std::map<std::string, double>& dials, double tilt_deg,
          FitMemory memory = {});

  // The same unknowns, held ones included, for other sides.
  FitCost with(std::vector<FitSide> sides, FitMemory memory) const;
  // The dials of heart::SectionShape are held at first.
  void searchSections();
  const std::vector<FitUnknown>& unknowns() const { return unknowns_; }
  std::size_t dials() const { return dials_; }  // the first unknowns
  std::size_t views() const { return sides_.size(); }
  const std::map<std::string, double>& fixed() const { return fixed_; }

  // Poses near those of `from`, or searched globally if it is empty. Runs in parallel.
  FitPlace at(const std::vector<double>& at, const std::vector<PoseFound>& from) const;
  // Parts of a place: values of the searched dials, all dials with the fixed ones, and the tilt of
  // a view's plane (none if tilts are not unknown).
  std::vector<double> searchedAt(const std::vector<double>& at) const;
  std::map<std::string, double> dialsAt(const std::vector<double>& at) const;
  PlaneTilt tiltAt(const std::vector<double>& at, std::size_t view) const;

  const HeartPrior& prior() const { return prior_; }
  double priorCost(const std::vector<double>& at) const;
  // A view's part of J at a place, with the pose found there.
  double viewCost(std::size_t view, const std::vector<double>& at, const PoseFound& found) const;
  // All dials, and the plane of this view; those of them that are not held.
  std::vector<std::size_t> unknownsOf(std::size_t view) const;
  std::vector<std::size_t> freeOf(std::size_t view) const;
  // A view's part of J without the prior, by differences about middleOf() a place, in steps. The
  // mixed derivatives of earlier ones are kept; empty: all are computed. Runs in parallel.
  std::vector<Quadratic> viewsAround(const FitPlace& place, const std::vector<Quadratic>& mixed,
                                     const Monitor& monitor) const;
  // Values of the unknowns with one of them kSlopeStep lower, and higher, within the limits.
  std::array<std::vector<double>, 2> besideIn(std::size_t unknown,
                                              const std::vector<double>& at) const;
  // Slopes of J in the units of the unknowns, by differences between besideIn(); 0 of held ones.
  // Runs in parallel.
  std::vector<double> slopesAt(const FitPlace& place, const Monitor& monitor) const;
  // The nearest place whose differences stay within the limits.
  std::vector<double> middleOf(const std::vector<double>& at) const;
  // sumOfViews() with the prior, in steps from a place. No curvature of the prior is below its
  // inverse variance.
  Quadratic sumOf(const std::vector<Quadratic>& views, const std::vector<double>& place) const;
  // Inverse of H in the units of the unknowns, row by row.
  std::vector<double> covariance(const Quadratic& q) const;
  // Values of the unknowns, given in steps from a place, within the limits. Held ones stay.
  std::vector<double> moved(const std::vector<double>& from,
                            const std::vector<double>& steps) const;
  // Where a quadratic, in steps from a place, is least within the limits and so many steps of each
  // unknown.
  std::vector<double> minimumNear(const Quadratic& q, const std::vector<double>& from,
                                  const std::vector<double>& most_steps) const;
  // Steps from one place to another.
  std::vector<double> stepsBetween(const std::vector<double>& from,
                                   const std::vector<double>& to) const;
  // Whether places differ by no more than so many steps of each unknown.
  bool within(double steps, const std::vector<double>& a, const std::vector<double>& b) const;

 private:
  PoseFound viewAt(std::size_t view, const std::vector<double>& at, const PoseFound* from) const;
  PoseFound evaluated(std::size_t view, const std::vector<double>& values, const PlaneTilt& tilt,
                      const PoseFound* from) const;
  Quadratic viewAround(std::size_t view, const PoseFound& from, const std::vector<double>& middle,
                       const Quadratic* mixed, const Monitor& monitor) const;
  Quadratic priorAround(const std::vector<double>& middle) const;
  double priorSd(std::size_t unknown) const;

  std::vector<FitSide> sides_;
  std::map<std::string, double> fixed_;
  std::vector<FitUnknown> unknowns_;
  std::size_t dials_ = 0;
  bool tilts_ = false;
  HeartPrior prior_;
  FitMemory memory_;
};

// Dials of the prior's table for a heart with these dials.
PriorDials priorDialsOf(const std::map<std::string, double>& dials);

}  // namespace echocine::fit
