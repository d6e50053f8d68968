#include "dataset/index_draws.h"

#include <algorithm>
#include <string_view>

#include "core/check.h"
#include "core/cholesky.h"
#include "core/error.h"
#include "core/hash_random.h"
#include "motion/heart/parameters.h"

namespace echocine::dataset {

namespace {

using heart::kHeartIndices;

struct Moments {
  heart::HeartIndices mean{};
  std::vector<double> covariance = std::vector<double>(kHeartIndices * kHeartIndices);
};

Moments momentsOf(const heart::HeartGroup& group) {
  Moments moments{group.mean};
  for (std::size_t i = 0; i < kHeartIndices; ++i)
    for (std::size_t j = 0; j < kHeartIndices; ++j)
      moments.covariance[i * kHeartIndices + j] =
          group.correlation[i * kHeartIndices + j] * group.sd[i] * group.sd[j];
  return moments;
}

Moments momentsOf(const std::vector<heart::HeartIndices>& draws) {
  Moments moments;
  const auto count = static_cast<double>(draws.size());
  for (const heart::HeartIndices& x : draws)
    for (std::size_t i = 0; i < kHeartIndices; ++i) moments.mean[i] += x[i] / count;
  for (const heart::HeartIndices& x : draws)
    for (std::size_t i = 0; i < kHeartIndices; ++i)
      for (std::size_t j = 0; j < kHeartIndices; ++j)
        moments.covariance[i * kHeartIndices + j] +=
            (x[i] - moments.mean[i]) * (x[j] - moments.mean[j]) / count;
  return moments;
}

// The dials of heart::kIndexDials.
std::array<const heart::Dial*, heart::kIndexDialCount> indexDials() {
  std::array<const heart::Dial*, heart::kIndexDialCount> found{};
  for (const heart::Dial& dial : heart::dials())
    for (std::size_t i = 0; i < found.size(); ++i)
      if (std::string_view(dial.key) == heart::kIndexDials[i]) found[i] = &dial;
  return found;
}

bool areWithinRanges(const heart::IndexDials& dials) {
  static const auto kFound = indexDials();
  for (std::size_t i = 0; i < dials.size(); ++i)
    if (!(dials[i] >= kFound[i]->low && dials[i] <= kFound[i]->high)) return false;
  return true;
}

heart::HeartIndices indicesFrom(const heart::HeartIndices& mean, const std::vector<double>& factor,
                                const heart::HeartIndices& z) {
  heart::HeartIndices x = mean;
  for (std::size_t i = 0; i < kHeartIndices; ++i)
    for (std::size_t j = 0; j <= i; ++j) x[i] += factor[i * kHeartIndices + j] * z[j];
  return x;
}

// The standard normals of one draw: those of the indices, and that of the body surface.
struct Scores {
  heart::HeartIndices index{};
  double surface = 0;
};

std::vector<Scores> fixedScores() {
  std::vector<Scores> all(10000);
  for (std::size_t n = 0; n < all.size(); ++n) {
    const auto z = [n](std::size_t i) {
      return normalFromHashes(hashOf(n, i, 1), hashOf(n, i, 2));
    };
    for (std::size_t i = 0; i < kHeartIndices; ++i) all[n].index[i] = z(i);
    all[n].surface = z(kHeartIndices);
  }
  return all;
}

// Draws of a normal distribution that the dials can have.
std::vector<heart::HeartIndices> possibleDraws(const Moments& normal,
                                               const std::vector<Scores>& scores) {
  const std::vector<double> factor = choleskyFactor(normal.covariance, kHeartIndices);
  CHECK_EQ(factor.empty(), false);
  std::vector<heart::HeartIndices> possible;
  for (const Scores& z : scores) {
    const heart::HeartIndices x = indicesFrom(normal.mean, factor, z.index);
    const double surface_m2 = heart::kBodySurface_m2 + heart::kBodySurfaceSd_m2 * z.surface;
    if (areWithinRanges(heart::dialsOf(x, surface_m2))) possible.push_back(x);
  }
  return possible;
}

}  // namespace

IndexDraws::IndexDraws(const heart::HeartGroup& group) : group_(group) {
  constexpr int kSteps = 15;
  const std::vector<Scores> scores = fixedScores();
  const Moments wanted = momentsOf(group);
  Moments normal = wanted;
  for (int step = 0; step < kSteps; ++step) {
    const Moments truncated = momentsOf(possibleDraws(normal, scores));
    for (std::size_t i = 0; i < kHeartIndices; ++i)
      normal.mean[i] += wanted.mean[i] - truncated.mean[i];
    for (std::size_t i = 0; i < normal.covariance.size(); ++i)
      normal.covariance[i] += wanted.covariance[i] - truncated.covariance[i];
  }
  mean_ = normal.mean;
  factor_ = choleskyFactor(normal.covariance, kHeartIndices);
  CHECK_EQ(factor_.empty(), false);
}

const IndexDraws& IndexDraws::of(std::size_t group) {
  static const std::array<IndexDraws, 2> kDraws{IndexDraws(heart::heartGroups()[0]),
                                                IndexDraws(heart::heartGroups()[1])};
  return kDraws[group];
}

IndexDraws::Drawn IndexDraws::draw(double surface_m2, const Normals& normals) const {
  constexpr std::size_t kMostDraws = 1000, kEach = kHeartIndices + 1;
  for (std::size_t tried = 0; tried < kMostDraws; ++tried) {
    heart::HeartIndices z{};
    for (std::size_t i = 0; i < kHeartIndices; ++i) z[i] = normals(tried * kEach + i);
    Drawn drawn;
    drawn.indices = indicesFrom(mean_, factor_, z);
    drawn.body_surface_m2 = surface_m2 + kSurfaceSd_m2 * normals(tried * kEach + kHeartIndices);
    drawn.dials = heart::dialsOf(drawn.indices, drawn.body_surface_m2);
    drawn.ejection_score =
        (drawn.indices[heart::kEjectionIndex] - group_.mean[heart::kEjectionIndex]) /
        group_.sd[heart::kEjectionIndex];
    if (areWithinRanges(drawn.dials)) return drawn;
  }
  throw SceneError("no indices of a heart are within the ranges of its dials");
}

}  // namespace echocine::dataset
