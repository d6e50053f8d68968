// Folds are found by bounds of the turn of faces. Here every face is examined at every instant.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "motion/heart/control_mesh.h"
#include "motion/heart/envelope.h"
#include "motion/heart/four_points.h"
#include "motion/heart/smooth.h"
#include "motion/heart/unfold.h"
#include "motion/keyframes/interpolation.h"
#include "motion/keyframes/keyframe_pair.h"

namespace echocine {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

using Points = std::vector<Vec3d>;

double angleBetween(Vec3d a, Vec3d b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) / kDegree;
}

Vec3d normalOf(const Points& points, const heart::Face& face) {
  const Vec3d a = points[face[0]];
  return cross(points[face[1]] - a, points[face[2]] - a);
}

Points pointsAt(const KeyframeWeights& weights, double phase, const std::vector<Points>& beat) {
  std::vector<double> shares(beat.size());
  weights.at(phase, shares);
  Points points(beat.front().size());
  for (std::size_t k = 0; k < beat.size(); ++k)
    for (std::size_t v = 0; v < points.size(); ++v) points[v] = points[v] + shares[k] * beat[k][v];
  return points;
}

bool isFolded(const Points& now, const Points& left, const Points& right,
              const std::vector<heart::Face>& faces, const std::vector<Neighbours>& hinges) {
  const auto normal = [&](std::uint32_t face) { return normalOf(now, faces[face]); };
  for (const Neighbours& hinge : hinges)
    if (angleBetween(normal(hinge.a), normal(hinge.b)) > 140) return true;
  for (const heart::Face& face : faces)
    if (angleBetween(normalOf(now, face), normalOf(left, face)) > 70 &&
        angleBetween(normalOf(now, face), normalOf(right, face)) > 70)
      return true;
  return false;
}

// The first keyframe at or after which there is a fold. At least as many instants as of a loop of
// 200 frames per beat.
std::optional<std::size_t> firstFold(const std::vector<double>& phases,
                                     const std::vector<Points>& beat,
                                     const std::vector<heart::Face>& faces) {
  const KeyframeWeights weights(phases, Interpolation::catmull_rom);
  const std::vector<Neighbours> hinges = neighboursOf(faces);
  for (std::size_t k = 0; k < beat.size(); ++k) {
    const double end = k + 1 < beat.size() ? phases[k + 1] : 1;
    const int instants = std::max(4, static_cast<int>(std::ceil((end - phases[k]) / 0.005)));
    for (int i = 0; i < instants; ++i) {
      const double phase = std::lerp(phases[k], end, static_cast<double>(i) / instants);
      if (isFolded(pointsAt(weights, phase, beat), beat[k], beat[(k + 1) % beat.size()], faces,
                   hinges))
        return k;
    }
  }
  return std::nullopt;
}

// A sphere whose places wander at random; some beats fold, some do not.
std::vector<Points> wanderingSphere(std::size_t keyframes, double range_m, std::mt19937& dice) {
  std::uniform_real_distribution<double> step(-range_m, range_m);
  const std::vector<Vec3d>& sphere = heart::geodesicSphere(3).directions;
  std::vector<Points> beat(keyframes);
  for (Points& points : beat)
    for (const Vec3d direction : sphere)
      points.push_back(0.05 * direction + Vec3d{step(dice), step(dice), step(dice)});
  return beat;
}

std::vector<double> unevenPhases(std::size_t count, std::mt19937& dice) {
  std::uniform_real_distribution<double> gap(0.5, 1);
  std::vector<double> phases{0};
  while (phases.size() <= count) phases.push_back(phases.back() + gap(dice));
  for (double& phase : phases) phase /= phases.back();
  phases.pop_back();
  return phases;
}

TEST(HeartFolds, AreThoseOfAllFacesAtAllInstants) {
  const std::vector<heart::Face>& faces = heart::geodesicSphere(3).faces;
  std::mt19937 dice(5);
  std::vector<int> with_folds(2, 0);
  for (const std::size_t keyframes : {1, 2, 3, 4, 5, 8, 13})
    for (const double range_m : {1e-3, 4e-3, 6e-3, 8e-3, 12e-3}) {
      std::vector<Points> beat = wanderingSphere(keyframes, range_m, dice);
      const std::vector<double> phases = unevenPhases(keyframes, dice);
      const heart::SurfaceBeat surface{phases, beat};
      const std::optional<heart::Fold> found = heart::Folds(surface, faces).first();
      const std::optional<std::size_t> wanted = firstFold(phases, beat, faces);
      ++with_folds[wanted.has_value()];
      ASSERT_EQ(found.has_value(), wanted.has_value()) << keyframes << " " << range_m;
      if (wanted) {
        EXPECT_EQ(found->keyframe, *wanted) << keyframes << " " << range_m;
      }
    }
  EXPECT_LT(5, with_folds[0]);
  EXPECT_LT(5, with_folds[1]);
}

// Faces far from folds keep their places.
TEST(HeartFolds, AreSmoothedWhereTheyAre) {
  const heart::SphereMesh& sphere = heart::geodesicSphere(8);
  std::vector<Points> beat(6);
  for (std::size_t k = 0; k < beat.size(); ++k)
    for (const Vec3d direction : sphere.directions)
      beat[k].push_back((0.05 + 1e-3 * static_cast<double>(k % 3)) * direction);
  const std::vector<double> phases{0, 0.2, 0.3, 0.5, 0.6, 0.8};
  const Vec3d own = sphere.directions[100];
  const Vec3d aside = normalised(cross(own, Vec3d{0.6, 0, 0.8}));
  for (Points& points : beat)
    points[100] = 0.05 * normalised(own + 0.3 * aside);  // past neighbours
  const std::vector<Points> before = beat;
  const heart::SurfaceBeat surface{phases, beat};
  heart::Folds folds(surface, sphere.faces);
  ASSERT_TRUE(folds.first());
  EXPECT_FALSE(folds.smooth());
  EXPECT_FALSE(firstFold(phases, beat, sphere.faces));
  std::size_t kept = 0;
  for (std::size_t v = 0; v < before[0].size(); ++v) {
    const bool is_far = length(before[0][v] - before[0][100]) > 0.06;
    for (std::size_t k = 0; is_far && k < beat.size(); ++k)
      EXPECT_EQ(length(beat[k][v] - before[k][v]), 0) << v;
    kept += length(beat[0][v] - before[0][v]) == 0;
  }
  EXPECT_LT(before[0].size() / 2, kept);
  EXPECT_LT(0, length(beat[0][100] - before[0][100]));
}

// In twice the digits.
TEST(HeartSmooth, HypotenuseIsWithinOneRounding) {
  std::mt19937_64 dice(11);
  std::uniform_real_distribution<double> exponent(-12, 2), sign(-1, 1);
  const auto length_m = [&] { return sign(dice) * std::pow(10, exponent(dice)); };
  for (int i = 0; i < 200000; ++i) {
    const double x = length_m(), y = i % 2 == 0 ? 4e-3 : length_m();
    const long double exact = std::sqrt(static_cast<long double>(x) * static_cast<long double>(x) +
                                        static_cast<long double>(y) * static_cast<long double>(y));
    const double found = heart::hypotenuse(x, y);
    EXPECT_LE(std::abs(static_cast<double>(static_cast<long double>(found) - exact)),
              1.01 * (std::nextafter(found, 1e9) - found));
  }
  EXPECT_EQ(heart::hypotenuse(0, 0), 0);
  EXPECT_EQ(heart::hypotenuse(-3, 4), 5);
  EXPECT_EQ(heart::hypotenuse(0.1, 0), 0.1);
}

TEST(HeartSmooth, LanesHaveTheBytesOfSingleNumbers) {
  std::mt19937_64 dice(12);
  std::uniform_real_distribution<double> length_m(-0.1, 0.1), share(0, 1), ratio(0.01, 4);
  for (int i = 0; i < 20000; ++i) {
    Doubles4 x, y, a, b, t;
    for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
      x[lane] = length_m(dice), y[lane] = i % 2 == 0 ? 4e-3 : length_m(dice);
      a[lane] = ratio(dice), b[lane] = ratio(dice), t[lane] = share(dice);
    }
    x[0] = 0, t[1] = 0, t[2] = 1, b[3] = a[3];
    const Doubles4 hypotenuse = heart::hypotenuse(x, y), most = heart::smoothMax(x, y, 4e-3),
                   step = heart::smoothStep(0, 0.35, x * 5), blend = heart::blended(a, b, t);
    for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
      EXPECT_EQ(hypotenuse[lane], heart::hypotenuse(x[lane], y[lane]));
      EXPECT_EQ(most[lane], heart::smoothMax(x[lane], y[lane], 4e-3));
      EXPECT_EQ(step[lane], heart::smoothStep(0, 0.35, x[lane] * 5));
      EXPECT_EQ(blend[lane], std::lerp(a[lane], b[lane], t[lane]));
    }
  }
}

// The farthest point within 13 degrees of each direction, by testing all points.
TEST(HeartEnvelope, ReachesTheFarthestPointInEachCone) {
  std::mt19937 dice(3);
  std::normal_distribution<double> normal;
  const Vec3d centre{0.01, -0.02, 0.03};
  Points points;
  for (int i = 0; i < 3000; ++i)
    points.push_back(centre + 0.04 * Vec3d{normal(dice), normal(dice), normal(dice)});
  for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1}, Vec3d{1, 1, 1}})
    points.push_back(centre + 0.2 * axis);
  const std::vector<Vec3d>& directions =
      heart::geodesicSphere(heart::Envelope::kFrequency).directions;
  std::vector<double> farthest_m;
  for (const Vec3d direction : directions) {
    double most_m = 0;
    for (const Vec3d point : points)
      if (angleBetween(point - centre, direction) <= 13)
        most_m = std::max(most_m, length(point - centre));
    farthest_m.push_back(most_m);
  }
  const Points surface = heart::Envelope(points, centre).points(0);
  const double cos_mean = std::cos(12.9 * kDegree);
  for (std::size_t d = 0; d < directions.size(); ++d) {
    double sum = 0, weights = 0;
    for (std::size_t e = 0; e < directions.size(); ++e) {
      const double weight = (dot(directions[d], directions[e]) - cos_mean) / (1 - cos_mean);
      if (weight >= 0) sum += weight * farthest_m[e], weights += weight;
    }
    EXPECT_NEAR(length(surface[d] - centre), sum / weights, 1e-12);
  }
}

}  // namespace
}  // namespace echocine
