// Medians, quartiles, and which settings no other one beats.

#include <gtest/gtest.h>

#include <cmath>

#include "core/hash_random.h"
#include "metrics/statistics.h"

namespace echocine {
namespace {

TEST(StudyStatistics, QuartilesOfKnownLists) {
  EXPECT_EQ(quartilesOf({}).median, 0);
  EXPECT_EQ(quartilesOf({3}).first_quartile, 3);
  EXPECT_EQ(quartilesOf({3}).third_quartile, 3);
  const Quartiles q = quartilesOf({5, 1, 4, 2, 3});
  EXPECT_EQ(q.first_quartile, 2);
  EXPECT_EQ(q.median, 3);
  EXPECT_EQ(q.third_quartile, 4);
  EXPECT_EQ(quartilesOf({1, 2}).median, 1.5);
}

TEST(StudyStatistics, AFrontOfKnownPoints) {
  EXPECT_TRUE(paretoFront({}).empty());
  EXPECT_EQ(paretoFront({{1, 5}, {2, 3}, {2, 4}, {3, 3}, {4, 1}, {5, 1}}),
            (std::vector<bool>{true, true, false, false, true, false}));
  EXPECT_EQ(paretoFront({{1, 1}, {1, 1}, {2, 2}}), (std::vector<bool>{true, true, false}));
}

// Nobody on the front is beaten, and everybody else is beaten by somebody on the front.
TEST(StudyStatistics, AFrontOfRandomPointsIsUnbeatenAndBeatsTheRest) {
  std::vector<CostAndError> points;
  for (std::uint64_t i = 0; i < 200; ++i)  // coarse, so that coordinates repeat
    points.push_back({std::floor(20 * uniformFromHash(hashOf(1, i))),
                      std::floor(20 * uniformFromHash(hashOf(2, i)))});
  const std::vector<bool> front = paretoFront(points);
  const auto beats = [&](std::size_t a, std::size_t b) {
    return points[a].cost <= points[b].cost && points[a].error <= points[b].error &&
           (points[a].cost < points[b].cost || points[a].error < points[b].error);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    bool beaten = false, beaten_by_front = false;
    for (std::size_t j = 0; j < points.size(); ++j) {
      beaten = beaten || beats(j, i);
      beaten_by_front = beaten_by_front || (front[j] && beats(j, i));
    }
    EXPECT_EQ(front[i], !beaten);
    EXPECT_EQ(beaten_by_front, beaten);
  }
}

}  // namespace
}  // namespace echocine
