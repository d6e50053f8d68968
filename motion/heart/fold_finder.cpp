#include "motion/heart/fold_finder.h"

#include <algorithm>
#include <cmath>

#include "core/stop.h"
#include "motion/heart/four_points.h"
#include "motion/keyframes/interpolation.h"
#include "motion/keyframes/keyframe_pair.h"

namespace echocine::heart {
namespace {

constexpr double kFoldedCosine = -0.766, kTurnedCosine = 0.342;  // of 140 and of 70 degrees

// Number of instants examined between keyframes: as many as a loop of 200 frames per beat shows,
// and some if keyframes are close. Our choice.
constexpr double kFoldStep = 0.005;  // of a beat
constexpr int kLeastBetween = 4;

int instantsBetween(double left, double right) {
  return std::max(kLeastBetween, static_cast<int>(std::ceil((right - left) / kFoldStep)));
}

FourPoints half(const FourPoints& a, const FourPoints& b) {
  return (Doubles4{} + 0.5) * (a + b);
}
Doubles4 squareOf(const FourPoints& a) {
  return dot(a, a);
}

// An edge of a face in the four keyframes about an interval, for four intervals.
struct EdgeLanes {
  EdgeLanes(const BeatRows& rows, std::size_t from, std::size_t to, std::size_t first) {
    const auto edge = [&](std::size_t axis, std::size_t shift) {
      return lanesAt(rows.before(to, axis, first) + shift) -
             lanesAt(rows.before(from, axis, first) + shift);
    };
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = {edge(0, i), edge(1, i), edge(2, i)};
  }
  std::array<FourPoints, 4> at;
};

}  // namespace

// Is the cosine between two normals below kFoldedCosine? False for a face without area.
bool FoldFinder::areFolded(const Normal& a, const Normal& b) {
  const double product = dot(a.area, b.area);
  return product < 0 && product * product > kFoldedCosine * kFoldedCosine * a.squared * b.squared;
}

// Is it below kTurnedCosine? True for a face without area.
bool FoldFinder::areTurned(const Normal& a, const Normal& b) {
  const double product = dot(a.area, b.area);
  return !(product > 0 &&
           product * product >= kTurnedCosine * kTurnedCosine * a.squared * b.squared);
}

FoldFinder::Normal FoldFinder::normalOf(Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d area = cross(b - a, c - a);
  return {area, dot(area, area)};
}

FoldFinder::FoldFinder(std::span<const double> phases, const std::vector<Face>& faces)
    : faces_(faces), instants_(phases.size()), known_(faces.size()) {
  for (const auto& [a, b] : neighboursOf(faces)) hinges_.push_back({a, b});
  const std::size_t count = phases.size(), padded = count + kDoubleLanes;
  for (std::vector<double>* bounds : {&before_, &after_, &half_}) bounds->assign(padded, 0);
  if (count < 2) {
    instants_.front().push_back({{0, 1.0}});
    return;
  }
  const KeyframeWeights weights(phases, Interpolation::catmull_rom);  // the default of a scene
  std::vector<KeyframeWeights::Term> sum;
  for (std::size_t k = 0; k < count; ++k) {
    const double start = phases[k], end = k + 1 < count ? phases[k + 1] : 1;
    const int instants = instantsBetween(start, end);
    instants_[k].push_back({{k, 1.0}});
    half_[k] = 0.5;
    for (int i = 1; i < instants; ++i) {
      weights.termsAt(std::lerp(start, end, static_cast<double>(i) / instants), sum);
      Terms& terms = instants_[k].emplace_back();
      for (const auto& [row, weight] : sum) terms.push_back({row, weight});
      if (terms.size() != 4) continue;  // at a keyframe
      before_[k] = std::max(before_[k], std::abs(terms[0].weight));
      half_[k] = std::max(half_[k], 0.5 * std::abs(terms[2].weight - terms[1].weight));
      after_[k] = std::max(after_[k], std::abs(terms[3].weight));
    }
  }
}

// With weights w that sum to 1, and the middle m of the interval's own keyframes a and b, an edge
// is m + (w_b - w_a) (b - a) / 2 + the sum of w (e - m) over the other two keyframes e. By Cauchy's
// inequality its change is at most the root of sum W * sum W d^2, for bounds W of the weights and
// the lengths d. The change of the normal e x f is at most |e| dF + |f| dE + dE dF.
FoldFinder::Middle FoldFinder::middleOf(const BeatRows& rows, const Face& face,
                                        std::size_t first) const {
  const Doubles4 before = lanesAt(&before_[first]), after = lanesAt(&after_[first]),
                 half_way = lanesAt(&half_[first]), sum = before + after + half_way;
  const auto changeOf = [&](const EdgeLanes& edge, const FourPoints& middle) {
    return sum *
           (before * squareOf(edge.at[0] - middle) + half_way * squareOf(edge.at[2] - edge.at[1]) +
            after * squareOf(edge.at[3] - middle));
  };
  const EdgeLanes e(rows, face[0], face[1], first), f(rows, face[0], face[2], first);
  const FourPoints a = half(e.at[1], e.at[2]), b = half(f.at[1], f.at[2]);
  const Doubles4 change_a = changeOf(e, a), change_b = changeOf(f, b);
  const Doubles4 square_a = squareOf(a), square_b = squareOf(b);
  const Doubles4 change = squareRoot(square_a * change_b) + squareRoot(square_b * change_a) +
                          squareRoot(change_a * change_b);
  const FourPoints normal = cross(a, b);
  const Doubles4 square = squareOf(normal);
  constexpr double kCalmSine = 0.34, kThin = 1e-12;  // below sin(20 deg); room for rounding
  const Mask4 is_calm =
      (change * change < kCalmSine * kCalmSine * square) & (square > kThin * square_a * square_b);
  return {normal.x, normal.y, normal.z, is_calm};
}

// Two calm faces whose middle normals are within 90 degrees stay within 130 degrees. A calm face is
// always within 40 degrees of its direction in the keyframes.
void FoldFinder::suspect(const BeatRows& rows, std::size_t first) {
  checkpoint();
  for (Suspects& suspects : suspects_) suspects.hinges.clear(), suspects.faces.clear();
  middles_.resize(faces_.size());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    middles_[f] = middleOf(rows, faces_[f], first);
    for (std::size_t i = 0; i < kDoubleLanes; ++i)
      if (!middles_[f].is_calm[i]) suspects_[i].faces.push_back(static_cast<std::uint32_t>(f));
  }
  for (const Hinge& hinge : hinges_) {
    const Middle &a = middles_[hinge.a], &b = middles_[hinge.b];
    const Mask4 is_open = (a.x * b.x + a.y * b.y + a.z * b.z >= 0) & a.is_calm & b.is_calm;
    for (std::size_t i = 0; i < kDoubleLanes; ++i)
      if (!is_open[i]) suspects_[i].hinges.push_back(hinge);
  }
}

FoldFinder::Normal FoldFinder::normalAt(const BeatRows& rows, std::size_t face,
                                        std::size_t keyframe) const {
  const auto& [a, b, c] = faces_[face];
  return normalOf(rows.at(a, keyframe), rows.at(b, keyframe), rows.at(c, keyframe));
}

FoldFinder::Normal FoldFinder::normalAt(const BeatRows& rows, std::size_t face,
                                        const Terms& terms) const {
  if (terms.size() == 1) return normalAt(rows, face, terms.front().keyframe);
  const auto at = [&](std::size_t v) {
    Vec3d point;
    for (const Term& term : terms) point = point + term.weight * rows.at(v, term.keyframe);
    return point;
  };
  const auto& [a, b, c] = faces_[face];
  return normalOf(at(a), at(b), at(c));
}

}  // namespace echocine::heart
