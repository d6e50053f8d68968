#pragma once
// Families and comparisons of all views of a fit, and what the found heart shows against itself.

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "fit/heart_fit.h"
#include "fit/own_look.h"
#include "fit/own_loop.h"

namespace echocine::fit {

struct FittedSides {
  std::vector<std::shared_ptr<const HeartFamily>> families;
  std::deque<ModelDiscrepancy> discrepancies;
  std::vector<ExpectedLook> looks;   // by view; nothing is expected before expectOwnLook()
  Look rendered_as = Look::scanner;  // of own loops
  // That of each loop (Eq. 26). From kMuchPersistence on, own loops have the same lag in beats;
  // otherwise they have the persistence of their look.
  std::vector<std::optional<double>> persistence;

  FittedSides() = default;
  FittedSides(const std::vector<FitLoop>& loops, std::vector<std::optional<double>> persistence,
              const HeartNodes& hearts, double tilt_deg, const Monitor& monitor);
  // With models of these dials, which find the beat. Costs of the earlier ones are invalid then. If
  // it throws, nothing has changed.
  void compare(const std::vector<FitLoop>& loops, const std::vector<double>& dials);
  std::vector<FitSide> refer() const;
  // Sets `rendered_as` to the look of a scanner whose own loops of the model at a place lower J
  // most, one loop in each view until its sum is far above the lowest. False if the monitor stopped
  // it; nothing has changed then. Throws like expectOwnLook().
  bool chooseLook(const FitCost& cost, const std::vector<heart::View>& views, const FitPlace& place,
                  const Monitor& monitor);
  // Measures the look of each view's model at a place, in kTwins own loops. Costs of the earlier
  // look are invalid then. False if the monitor stopped it; nothing has changed then. Throws
  // SceneError for an impossible heart. Precondition: the place has poses. Rounds have other loops.
  bool expectOwnLook(const FitCost& cost, const std::vector<heart::View>& views,
                     const FitPlace& place, const Monitor& monitor, int round = 0);
  // A view's model at a place of the cost, as FitCost evaluates it.
  ModelLoop modelAt(std::size_t view, const FitCost& cost, const FitPlace& place) const;
  // The same without the expected look.
  ModelLoop plainAt(std::size_t view, const FitCost& cost, const FitPlace& place) const;
  // A view's heart at a place. Throws like expectOwnLook().
  OwnHeart ownHeartOf(std::size_t view, const FitCost& cost, heart::View name,
                      const FitPlace& place) const;
  // Its own loops in a look. `other`: as OwnHeart::beats().
  RenderedBeats ownLoopsOf(std::size_t view, const OwnHeart& heart, Look look,
                           const RenderedBeats* other = nullptr) const;

 private:
  ExpectedSlope slopeOf(std::size_t view, const OwnDiscrepancies& own, const FitCost& cost,
                        const FitPlace& place) const;
};

// A fit of the best heart's own rendered loops.
struct OwnFit {
  std::vector<OwnSight> sight;  // by view
  // Found minus rendered, by dial. Those of heart::SectionShape are held, so they have none.
  std::map<std::string, double> error;
  // By view: the heart that the fit finds in its own loop, against this loop; then against kTwins
  // own loops, the first included. They have the bias of the fit.
  std::vector<FitReport> report;
  std::vector<std::vector<FitMap>> twins;
};

// None if the monitor stopped it. Throws SceneError for an impossible heart. Runs in parallel.
std::optional<OwnFit> fitOwnLoops(const FittedSides& sides, const FitCost& cost,
                                  const std::vector<heart::View>& views, const FitPlace& best,
                                  double tilt_deg, const Monitor& monitor,
                                  const std::shared_ptr<FitJournal>& journal = {});

// Moves the dials of a place towards the middle of their ranges by a quarter of the distance until
// a heart has them. False if nothing was moved.
bool makePossible(const FitCost& cost, std::vector<double>& at);

}  // namespace echocine::fit
