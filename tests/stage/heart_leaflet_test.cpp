// Valves and papillary muscles of the parametric heart over its beat.

#include <gtest/gtest.h>

#include <functional>

#include "support/recorded_heart.h"

namespace echocine {
namespace {

using namespace support;
using heart::kLeafletColumns, heart::kLeafletRows;

using Points = std::vector<Vec3d>;

// A beat in instants between all events; the parts at each, made once.
constexpr int kInstants = 25;
double phaseOf(int instant) {
  return (instant + 0.5) / kInstants;
}
const std::vector<heart::Part>& partsAt(int instant) {
  static std::map<int, std::vector<heart::Part>> made;
  auto& parts = made[instant];
  if (parts.empty()) parts = defaultHeart().at(phaseOf(instant));
  return parts;
}
const Points& pointsAt(int instant, const std::string& part) {
  return partOf(partsAt(instant), part).points;
}
int instantNear(double phase) {
  return static_cast<int>(phase * kInstants);
}

Vec3d at(const Points& points, int row, int column) {
  return points[static_cast<std::size_t>(row * kLeafletColumns + column)];
}

// Along a column from the hinge to the free edge.
double lengthOf(const Points& points, int column) {
  double sum = 0;
  for (int r = 1; r < kLeafletRows; ++r)
    sum += length(at(points, r, column) - at(points, r - 1, column));
  return sum;
}

// What a leaflet covers of its ring's plane.
double coveredArea(const Points& points, Vec3d flow) {
  double area = 0;
  for (const Triangle& t : heart::sheetFaces(kLeafletRows, kLeafletColumns)) {
    const Vec3d a = points[t[0]];
    area += 0.5 * std::abs(dot(cross(points[t[1]] - a, points[t[2]] - a), flow));
  }
  return area;
}

struct Valve {
  std::vector<std::string> leaflets;
  bool outflow, right;
};
const std::vector<Valve>& valves() {
  static const std::vector<Valve> all{
      {{"mitral_anterior", "mitral_posterior"}, false, false},
      {{"tricuspid_septal", "tricuspid_anterior"}, false, true},
      {{"aortic_left", "aortic_right", "aortic_non_coronary"}, true, false},
      {{"pulmonary_left", "pulmonary_anterior", "pulmonary_right"}, true, true}};
  return all;
}

// The plane of a valve's hinges, from points a good way apart on its ring.
Vec3d ringNormal(const Valve& valve, int instant) {
  const Points &a = pointsAt(instant, valve.leaflets[0]), &b = pointsAt(instant, valve.leaflets[1]);
  return normalised(cross(at(a, 0, 8) - at(a, 0, 0), at(b, 0, 4) - at(a, 0, 0)));
}
// Between the ends of the first leaflet's hinge: tells the ring's size.
double ringChord(const Valve& valve, int instant) {
  const Points& points = pointsAt(instant, valve.leaflets[0]);
  return length(at(points, 0, 0) - at(points, 0, kLeafletColumns - 1));
}
// Against the square over the ring's chord.
double coveredBy(const Valve& valve, int instant) {
  double area = 0;
  for (const std::string& name : valve.leaflets)
    area += coveredArea(pointsAt(instant, name), ringNormal(valve, instant));
  return area / std::pow(ringChord(valve, instant), 2);
}

CycleEvents eventsOf(const Valve& valve) {
  return cycleEvents(phaseDurations(defaultHeart().parameters().heart_rate_bpm / 60,
                                    valve.right ? Ventricle::right : Ventricle::left));
}
bool mayBeOpen(const Valve& valve, double phase) {
  const CycleEvents e = eventsOf(valve);
  return valve.outflow ? phase > e.aortic_opens && phase < e.aortic_closes : phase > e.mitral_opens;
}

TEST(HeartLeaflets, HingesStayOnOneRingPerValve) {
  for (const Valve& valve : valves())
    for (int i = 0; i < kInstants; i += 3) {
      const Vec3d normal = ringNormal(valve, i);
      const Vec3d first = at(pointsAt(i, valve.leaflets[0]), 0, 0);
      for (const std::string& name : valve.leaflets)
        for (int c = 0; c < kLeafletColumns; ++c)
          ASSERT_LT(std::abs(dot(at(pointsAt(i, name), 0, c) - first, normal)), 1e-4) << name;
    }
}

// The tricuspid ring narrows in systole, and its leaflets with it.
TEST(HeartLeaflets, KeepTheirLengthAgainstTheirRingOverTheBeat) {
  for (const Valve& valve : valves())
    for (const std::string& name : valve.leaflets)
      for (int c = 0; c < kLeafletColumns; ++c) {
        const double rest_m = lengthOf(pointsAt(0, name), c);
        EXPECT_GT(rest_m, 2e-3) << name;
        for (int i = 3; i < kInstants; i += 3) {
          const double ring = ringChord(valve, i) / ringChord(valve, 0);
          ASSERT_NEAR(lengthOf(pointsAt(i, name), c), ring * rest_m, 0.03 * rest_m) << name;
          const bool is_tricuspid = valve.right && !valve.outflow;
          ASSERT_NEAR(ring, 1, is_tricuspid ? 0.15 : 0.01) << name;
        }
      }
}

// Nearest distance from the middle of a leaflet's free edge to another leaflet's points.
double edgeGap(const Points& leaflet, const Points& other) {
  double widest = 0;
  for (int c = 2; c <= 6; ++c) {
    double gap = 1;
    for (int k = 0; k < 2 * kLeafletColumns - 1; ++k) {
      const Vec3d on_edge =
          0.5 * (at(other, kLeafletRows - 1, k / 2) + at(other, kLeafletRows - 1, (k + 1) / 2));
      gap = std::min(gap, length(at(leaflet, kLeafletRows - 1, c) - on_edge));
    }
    widest = std::max(widest, gap);
  }
  return widest;
}

TEST(HeartLeaflets, ClosedPairsMeetAlongTheirMiddleAndOpenOnesPart) {
  for (const Valve& valve : valves()) {
    if (valve.outflow) continue;
    const CycleEvents e = eventsOf(valve);
    const int shut = instantNear(0.5 * (e.aortic_opens + e.aortic_closes)),
              open = instantNear(e.mitral_opens + 0.11);
    const auto gap = [&](int instant) {
      return edgeGap(pointsAt(instant, valve.leaflets[0]), pointsAt(instant, valve.leaflets[1]));
    };
    EXPECT_LT(gap(shut), 3e-3) << valve.leaflets[0];
    EXPECT_GT(gap(open), 8e-3) << valve.leaflets[0];
  }
}

TEST(HeartLeaflets, ClosedCuspsMeetInTheMiddle) {
  for (const Valve& valve : valves()) {
    if (!valve.outflow) continue;
    const CycleEvents e = eventsOf(valve);
    const int shut = instantNear(0.8), open = instantNear(0.5 * (e.aortic_opens + e.aortic_closes));
    const auto spread = [&](int instant) {
      const auto tip = [&](std::size_t i) {
        return at(pointsAt(instant, valve.leaflets[i]), kLeafletRows - 1, kLeafletColumns / 2);
      };
      return std::max({length(tip(0) - tip(1)), length(tip(1) - tip(2)), length(tip(2) - tip(0))});
    };
    EXPECT_LT(spread(shut), 3e-3) << valve.leaflets[0];
    EXPECT_GT(spread(open), 8e-3) << valve.leaflets[0];
  }
}

// A closed valve always covers the same of its ring.
TEST(HeartLeaflets, OpenOnlyInTheirTime) {
  for (const Valve& valve : valves()) {
    int shut_instant = 0;
    while (mayBeOpen(valve, phaseOf(shut_instant))) ++shut_instant;
    const double shut = coveredBy(valve, shut_instant);
    double least = 1;
    for (int i = 0; i < kInstants; ++i) {
      const double covered = coveredBy(valve, i) / shut;
      const bool may_be_open = mayBeOpen(valve, phaseOf(i));
      if (may_be_open) least = std::min(least, covered);
      EXPECT_TRUE(may_be_open || std::abs(covered - 1) < 0.03)
          << valve.leaflets[0] << " at " << phaseOf(i) << ": " << covered;
    }
    EXPECT_LT(least, 0.50) << valve.leaflets[0];
    EXPECT_GT(shut, 0.6) << valve.leaflets[0];  // a disc over its diameter squared: 0.785
  }
}

// In its time a valve is well open: the mitral one in rapid filling and in the kick, less between.
TEST(HeartLeaflets, TheMitralValveOpensTwiceABeat) {
  const Valve& mitral = valves()[0];
  const CycleEvents e = eventsOf(mitral);
  const double shut = coveredBy(mitral, 0);
  const double rapid = coveredBy(mitral, instantNear(e.mitral_opens + 0.11)),
               between = coveredBy(mitral, instantNear(e.atrial_kick_begins - 0.02)),
               kick = coveredBy(mitral, instantNear(e.atrial_kick_begins + 0.07));
  EXPECT_LT(rapid, 0.5 * shut);
  EXPECT_GT(between, rapid + 0.1 * shut);
  EXPECT_LT(kick, between - 0.1 * shut);
}

TEST(HeartLeaflets, AnOpeningOfZeroKeepsAValveShut) {
  const heart::ParametricHeart ill(heart::parametersFrom({{"mitral-opening", 0.0}}));
  const Valve& mitral = valves()[0];
  const int filling = instantNear(eventsOf(mitral).mitral_opens + 0.11);
  const std::vector<heart::Part> parts = ill.at(phaseOf(filling));
  double area = 0, shut = 0;
  for (const std::string& name : mitral.leaflets) {
    area += coveredArea(partOf(parts, name).points, {0, 0, 1});
    shut += coveredArea(pointsAt(0, name), {0, 0, 1});
  }
  EXPECT_NEAR(area, shut, 0.01 * shut);
}

TEST(HeartParts, AreTheSameAtEveryInstantAndTheClosedOnesAreClosed) {
  const std::vector<heart::Part>& first = partsAt(0);
  EXPECT_EQ(first.size(), 26u);
  for (int i = 1; i < kInstants; i += 4) {
    ASSERT_EQ(partsAt(i).size(), first.size());
    for (std::size_t p = 0; p < first.size(); ++p) {
      EXPECT_EQ(partsAt(i)[p].kind.name, first[p].kind.name);
      EXPECT_EQ(partsAt(i)[p].faces, first[p].faces);
    }
  }
  for (const heart::Part& part : first) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
    for (const heart::Face& f : part.faces)
      for (std::size_t k = 0; k < 3; ++k) ++runs[{f[k], f[(k + 1) % 3]}];
    int open = 0;
    for (const auto& [edge, count] : runs) {
      EXPECT_EQ(count, 1) << part.kind.name;
      open += runs.count({edge.second, edge.first}) == 0 ? 1 : 0;
    }
    const int rim = 2 * (kLeafletRows + kLeafletColumns - 2);
    EXPECT_EQ(open, part.kind.membrane ? rim : 0) << part.kind.name;
    EXPECT_TRUE(part.kind.membrane || fluxVolume({part.points, part.faces}) > 0) << part.kind.name;
  }
}

TEST(HeartPapillaries, StayWithinTheLeftVentricle) {
  for (int i = 0; i < kInstants; i += 3) {
    const heart::Part& wall = partOf(partsAt(i), "lv_wall");
    const heart::Part& cavity = partOf(partsAt(i), "lv_cavity");
    const Mesh outside{wall.points, wall.faces}, blood{cavity.points, cavity.faces};
    for (const char* name : {"papillary_anterolateral", "papillary_posteromedial"}) {
      const Points& points = pointsAt(i, name);
      int in_blood = 0, count = 0;
      for (std::size_t k = 0; k < points.size(); k += 3, ++count) {
        ASSERT_TRUE(isInside(outside, points[k])) << name << " at " << phaseOf(i);
        in_blood += isInside(blood, points[k]);
      }
      EXPECT_GT(in_blood, count / 2) << name;  // it stands in the cavity,
      EXPECT_LT(in_blood, count) << name;      // rooted in the wall
    }
  }
}

}  // namespace
}  // namespace echocine
