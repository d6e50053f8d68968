#include "motion/heart/segment_shares.h"

#include <algorithm>
#include <cmath>

#include "motion/heart/heart_units.h"
#include "motion/heart/smooth.h"

namespace echocine::heart {
namespace {

// A ring of segments, counted in the Association's order: basal and mid rings start with the
// anterior segment, 60 degrees apart; the apical one with its anterior segment, 90 degrees apart.
struct SegmentRing {
  double zeta;  // of the segments' centres; our choice: thirds of the wall, and the cap
  int first, count;
  double start_rad;  // centre of the first; the count goes by the septum
};
constexpr std::array<SegmentRing, 4> kRings{
    {{0.17, 0, 6, kTurn / 6}, {0.50, 6, 6, kTurn / 6}, {0.80, 12, 4, kTurn / 6}, {0.97, 16, 1, 0}}};

void addRing(const SegmentRing& ring, double phi_rad, double share,
             std::array<double, kSegments>& shares) {
  double place = (phi_rad - ring.start_rad) / kTurn * ring.count;
  place -= std::floor(place / ring.count) * ring.count;
  const int here = static_cast<int>(place) % ring.count;
  const double next = smoothStep(0, 1, place - std::floor(place));
  shares[ring.first + here] += share * (1 - next);
  shares[ring.first + (here + 1) % ring.count] += share * next;
}

}  // namespace

std::array<double, kSegments> segmentShares(double phi_rad, double zeta) {
  std::array<double, kSegments> shares{};
  std::size_t above = 0;
  while (above < kRings.size() && kRings[above].zeta < zeta) ++above;
  if (above == 0 || above == kRings.size()) {
    addRing(kRings[std::min(above, kRings.size() - 1)], phi_rad, 1, shares);
    return shares;
  }
  const SegmentRing &low = kRings[above - 1], &high = kRings[above];
  const double t = smoothStep(low.zeta, high.zeta, zeta);
  addRing(low, phi_rad, 1 - t, shares);
  addRing(high, phi_rad, t, shares);
  return shares;
}

SegmentPlace segmentCentre(int segment) {
  std::size_t r = kRings.size() - 1;
  while (kRings[r].first > segment) --r;
  const SegmentRing& ring = kRings[r];
  return {ring.start_rad + kTurn * (segment - ring.first) / ring.count, ring.zeta};
}

}  // namespace echocine::heart
