// Where the parametric heart's valves and chambers stand, against a heart segmented from CT
// (HeartDeformNets' template: LV wall, LA, LV, RA, RV, aorta, pulmonary artery).

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "support/paths.h"
#include "support/recorded_heart.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;

const std::filesystem::path kStatics = std::filesystem::path(support::kSharedDir) / "real/statics",
                            kStatic = kStatics / "heartdeform_whole_heart",
                            kFourChambers = kStatics / "ghdheart_4ch";

using Points = std::vector<Vec3d>;

// A heart in any unit and place.
struct Anatomy {
  Points lv, rv, la, ra;
  Vec3d apex, mitral, tricuspid, aortic, pulmonary;  // valves by their centres
  Vec3d aortic_flow;                                 // unit
};

// Those points of either surface that lie near the other: the rim of a valve between two chambers.
Points rimOf(const Points& a, const Points& b, double apart) {
  Points rim;
  const auto collect = [&](const Points& from, const Points& to) {
    for (const Vec3d p : from)
      if (std::any_of(to.begin(), to.end(), [&](Vec3d q) { return length(q - p) < apart; }))
        rim.push_back(p);
  };
  collect(a, b);
  collect(b, a);
  return rim;
}

// Across the plane through points: the direction in which they spread least, by power iteration.
Vec3d normalOf(const Points& points) {
  const Vec3d middle = meanOf(points);
  double trace = 0;
  for (const Vec3d p : points) trace += dot(p - middle, p - middle);
  Vec3d normal = normalised(Vec3d{1, 2, 3});
  for (int i = 0; i < 500; ++i) {
    Vec3d next = trace * normal;
    for (const Vec3d p : points) next = next - dot(p - middle, normal) * (p - middle);
    normal = normalised(next);
  }
  return normal;
}

Vec3d furthestFrom(Vec3d place, const Points& points) {
  return *std::max_element(points.begin(), points.end(),
                           [&](Vec3d a, Vec3d b) { return length(a - place) < length(b - place); });
}

Anatomy staticHeart() {
  const auto region = [](int number) {
    return meshOfObj(bytesOf(kStatic / fmt::format("region_{}.obj", number))).points;
  };
  constexpr double kApart = 0.02;  // of the unit cube: 2.5 mm or so
  Anatomy it{region(3), region(5), region(2), region(4), {}, {}, {}, {}, {}, {}};
  const Points aortic = rimOf(region(6), it.lv, kApart);
  it.mitral = meanOf(rimOf(it.la, it.lv, kApart));
  it.tricuspid = meanOf(rimOf(it.ra, it.rv, kApart));
  it.aortic = meanOf(aortic);
  it.pulmonary = meanOf(rimOf(region(7), it.rv, kApart));
  it.apex = furthestFrom(it.mitral, it.lv);
  it.aortic_flow = normalOf(aortic);
  if (dot(it.aortic_flow, it.apex - it.mitral) > 0) it.aortic_flow = -it.aortic_flow;
  return it;
}

Anatomy parametricHeart() {
  const heart::ParametricHeart made(heart::parametersFrom({}));
  const std::vector<heart::Part> parts = made.at(0);
  const heart::Landmarks marks = made.landmarksAt(0);
  return {partOf(parts, "lv_cavity").points,
          partOf(parts, "rv_cavity").points,
          partOf(parts, "la").points,
          partOf(parts, "ra").points,
          marks.apex,
          marks.mitral,
          marks.tricuspid,
          marks.aortic,
          marks.pulmonary,
          marks.aortic_flow};
}

// Origin at the mitral ring, z to the apex, x away from the tricuspid ring; unit: the length from
// ring to apex.
struct OwnFrame {
  Vec3d origin, x, y, z;
  double unit;
  explicit OwnFrame(const Anatomy& it) : origin(it.mitral) {
    unit = length(it.apex - it.mitral);
    z = (1 / unit) * (it.apex - it.mitral);
    const Vec3d aside = it.mitral - it.tricuspid;
    x = normalised(aside - dot(aside, z) * z);
    y = cross(z, x);
  }
  Vec3d direction(Vec3d v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  Vec3d of(Vec3d p) const { return (1 / unit) * direction(p - origin); }
};

struct Reach {
  Vec3d low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
};
Vec3d extentOf(const Points& points, const OwnFrame& frame) {
  Reach extent;
  for (const Vec3d p : points) {
    const Vec3d q = frame.of(p);
    extent.low = {std::min(extent.low.x, q.x), std::min(extent.low.y, q.y),
                  std::min(extent.low.z, q.z)};
    extent.high = {std::max(extent.high.x, q.x), std::max(extent.high.y, q.y),
                   std::max(extent.high.z, q.z)};
  }
  return extent.high - extent.low;
}

struct Row {
  std::string what;
  double value;
  bool is_angle;  // deg; else a ratio of lengths
};

double degrees(double rad) {
  return rad * 180 / std::numbers::pi;
}

std::vector<Row> measured(const Anatomy& it) {
  const OwnFrame frame(it);
  std::vector<Row> rows;
  const auto addAngle = [&](const char* what, Vec3d point) {
    const Vec3d p = frame.of(point);
    rows.push_back(
        {fmt::format("{}, angle about the LV axis", what), degrees(std::atan2(p.y, p.x)), true});
  };
  addAngle("aortic valve", it.aortic);
  addAngle("pulmonary valve", it.pulmonary);
  addAngle("RV centroid", meanOf(it.rv));
  addAngle("RA centroid", meanOf(it.ra));
  const auto addTilt = [&](const char* what, Vec3d direction) {
    const Vec3d d = normalised(frame.direction(direction));
    rows.push_back({fmt::format("{}, angle to the LV axis", what), degrees(std::acos(-d.z)), true});
  };
  addTilt("aortic valve's normal", it.aortic_flow);
  addTilt("mitral valve to LA centroid", meanOf(it.la) - it.mitral);
  addTilt("tricuspid valve to RA centroid", meanOf(it.ra) - it.tricuspid);
  const auto addDistance = [&](const char* what, Vec3d a, Vec3d b) {
    rows.push_back({fmt::format("{}, over LV length", what), length(a - b) / frame.unit, false});
  };
  addDistance("mitral to tricuspid valve", it.mitral, it.tricuspid);
  addDistance("mitral to aortic valve", it.mitral, it.aortic);
  addDistance("mitral to pulmonary valve", it.mitral, it.pulmonary);
  addDistance("tricuspid to pulmonary valve", it.tricuspid, it.pulmonary);
  const auto addExtents = [&](const char* what, const Points& points) {
    const Vec3d extent = extentOf(points, frame);
    rows.push_back(
        {fmt::format("{} across, over LV length", what), std::sqrt(extent.x * extent.y), false});
    rows.push_back({fmt::format("{} along, over LV length", what), extent.z, false});
  };
  addExtents("LV", it.lv);
  addExtents("RV", it.rv);
  // Of the atria the shape alone: the segmented ones are twice the left ventricle's volume.
  const auto addShape = [&](const char* what, const Points& points) {
    const Vec3d extent = extentOf(points, frame);
    rows.push_back({fmt::format("{} along over across", what),
                    extent.z / std::sqrt(extent.x * extent.y), false});
  };
  addShape("LA", it.la);
  addShape("RA", it.ra);
  return rows;
}

// Points of one surface within a distance of the other.
std::ptrdiff_t countNear(const Points& from, const Points& to, double apart_m) {
  return std::count_if(from.begin(), from.end(), [&](Vec3d p) {
    return std::any_of(to.begin(), to.end(), [&](Vec3d q) { return length(p - q) < apart_m; });
  });
}

// Over an area; our choice. The wall between the chambers is 2 mm thick.
TEST(HeartAnatomyLaw, TheSeptumBetweenTheAtriaIsThinThroughoutTheBeat) {
  const heart::ParametricHeart made(heart::parametersFrom({}));
  for (const double phase : {0.0, 0.2, 0.36, 0.5, 0.75, 0.95}) {
    const std::vector<heart::Part> parts = made.at(phase);
    const Points &left = partOf(parts, "la").points, &right = partOf(parts, "ra").points;
    const auto near = countNear(right, left, 6e-3);
    std::printf("phase %.2f: %d points of the right atrium within 6 mm of the left one\n", phase,
                static_cast<int>(near));
    EXPECT_GE(near, 8) << phase;
    EXPECT_EQ(countNear(right, left, 1.5e-3), 0) << phase;
  }
}

// The static heart is another person's: these are bounds for one kind.
constexpr double kAngle_deg = 25, kRatio = 0.35;

TEST(HeartAnatomyLaw, ValvesAndChambersStandWhereASegmentedHeartHasThem) {
  if (!std::filesystem::is_directory(kStatic)) GTEST_SKIP() << kStatic << " is not there";
  const std::vector<Row> ours = measured(parametricHeart()), theirs = measured(staticHeart());
  std::printf("| measure | parametric | segmented | difference |\n|---|---|---|---|\n");
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (ours[i].is_angle) {
      const double apart = std::remainder(ours[i].value - theirs[i].value, 360);
      std::printf("| %s | %.0f deg | %.0f deg | %+.0f deg |\n", ours[i].what.c_str(), ours[i].value,
                  theirs[i].value, apart);
      EXPECT_LT(std::abs(apart), kAngle_deg) << ours[i].what;
    } else {
      const double more = ours[i].value / theirs[i].value - 1;
      std::printf("| %s | %.2f | %.2f | %+.0f %% |\n", ours[i].what.c_str(), ours[i].value,
                  theirs[i].value, 100 * more);
      EXPECT_LT(std::abs(more), kRatio) << ours[i].what;
    }
  }
}

// Chamber sizes against another heart, segmented from CT with atria of usual size; in mid-diastole,
// where CT is gated.
TEST(HeartAnatomyLaw, ChambersAreAsLargeAgainstTheLeftVentricleAsSegmentedOnes) {
  if (!std::filesystem::is_directory(kFourChambers)) GTEST_SKIP() << kFourChambers << " is absent";
  const std::vector<heart::Part> parts = heart::ParametricHeart(heart::parametersFrom({})).at(0.75);
  const auto ours = [&](const char* name) {
    const heart::Part& part = partOf(parts, name);
    return fluxVolume({part.points, part.faces});
  };
  const auto theirs = [](const char* name) {
    return fluxVolume(meshOfObj(bytesOf(kFourChambers / (std::string(name) + ".obj"))));
  };
  struct Pair {
    const char *part, *file;
  };
  for (const Pair& pair : {Pair{"rv_cavity", "RV"}, Pair{"la", "LA"}, Pair{"ra", "RA"}}) {
    const double our_size = std::cbrt(ours(pair.part) / ours("lv_cavity")),
                 their_size = std::cbrt(theirs(pair.file) / theirs("LV"));
    const double more = our_size / their_size - 1;
    std::printf("| %s size over LV's (cube roots of volumes) | %.2f | %.2f | %+.0f %% |\n",
                pair.file, our_size, their_size, 100 * more);
    EXPECT_LT(std::abs(more), kRatio) << pair.part;
  }
}

}  // namespace
}  // namespace echocine
