#include "motion/heart/unfold.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/stop.h"
#include "motion/keyframes/interpolation.h"
#include "motion/keyframes/keyframe_pair.h"

namespace echocine::heart {
namespace {

constexpr double kFoldedCosine = -0.766, kTurnedCosine = 0.342;  // of 140 and of 70 degrees

// A face's normal, with twice its area as its length. The sign of a product decides most pairs, so
// normals are not normalised.
struct Normal {
  Vec3d area;
  double squared;
};

// Is the cosine between two normals below kFoldedCosine? False for a face without area.
bool areFolded(const Normal& a, const Normal& b) {
  const double product = dot(a.area, b.area);
  return product < 0 && product * product > kFoldedCosine * kFoldedCosine * a.squared * b.squared;
}
// Is it below kTurnedCosine? True for a face without area.
bool areTurned(const Normal& a, const Normal& b) {
  const double product = dot(a.area, b.area);
  return !(product > 0 &&
           product * product >= kTurnedCosine * kTurnedCosine * a.squared * b.squared);
}

// Number of instants examined between keyframes: as many as a loop of 200 frames per beat shows,
// and some if keyframes are close. Our choice.
constexpr double kFoldStep = 0.005;  // of a beat
constexpr int kLeastBetween = 4;

int instantsBetween(double left, double right) {
  return std::max(kLeastBetween, static_cast<int>(std::ceil((right - left) / kFoldStep)));
}

using Ring = std::vector<std::uint32_t>;

std::vector<Ring> ringsOf(std::size_t count, const std::vector<Face>& faces) {
  std::vector<Ring> rings(count);
  for (const Face& face : faces)  // each edge of a closed surface runs once in either direction
    for (std::size_t k = 0; k < 3; ++k) rings[face[k]].push_back(face[(k + 1) % 3]);
  return rings;
}

// Looks for folds in a surface.
class FoldFinder {
 public:
  explicit FoldFinder(const std::vector<Face>& faces)
      : faces_(faces), hinges_(neighboursOf(faces)) {}

  // Calls found(keyframe, face) for every face in a fold until it returns false.
  template <typename Found>
  void look(const SurfaceBeat& beat, Found&& found) {
    const std::size_t count = beat.points.size();
    // The default interpolation of a scene.
    std::optional<KeyframeWeights> weights;
    if (count > 1) weights.emplace(beat.phases, Interpolation::catmull_rom);
    std::vector<Normal> left, right = normalsOf(beat.points.front());
    for (std::size_t k = 0; k < count; ++k) {
      checkpoint();
      left = std::move(right);
      right = normalsOf(beat.points[(k + 1) % count]);
      const double start = beat.phases[k], end = k + 1 < count ? beat.phases[k + 1] : 1;
      const int instants = count > 1 ? instantsBetween(start, end) : 1;
      for (int i = 0; i < instants; ++i) {
        const double phase = std::lerp(start, end, static_cast<double>(i) / instants);
        const std::vector<Normal> now =
            i == 0 ? left : normalsOf(pointsAt(phase, *weights, beat.points));
        for (const Neighbours& hinge : hinges_)
          if (areFolded(now[hinge.a], now[hinge.b]) && !(found(k, hinge.a) && found(k, hinge.b)))
            return;
        for (std::size_t f = 0; f < now.size(); ++f)
          if (areTurned(now[f], left[f]) && areTurned(now[f], right[f]) && !found(k, f)) return;
      }
    }
  }

 private:
  static std::vector<Vec3d> pointsAt(double phase, const KeyframeWeights& weights,
                                     const std::vector<std::vector<Vec3d>>& keyframes) {
    std::vector<KeyframeWeights::Term> terms;
    weights.termsAt(phase, terms);
    std::vector<Vec3d> points(keyframes.front().size());
    for (const KeyframeWeights::Term& term : terms)
      for (std::size_t v = 0; v < points.size(); ++v)
        points[v] = points[v] + term.weight * keyframes[term.row][v];
    return points;
  }
  std::vector<Normal> normalsOf(const std::vector<Vec3d>& points) const {
    std::vector<Normal> normals(faces_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const Vec3d a = points[faces_[f][0]];
      const Vec3d area = cross(points[faces_[f][1]] - a, points[faces_[f][2]] - a);
      normals[f] = {area, dot(area, area)};
    }
    return normals;
  }

  const std::vector<Face>& faces_;
  std::vector<Neighbours> hinges_;
};

// Spreads weights to neighbours, halved with each ring of vertices.
void spread(const std::vector<Ring>& rings, std::vector<double>& share) {
  constexpr int kSpreadRings = 3;
  for (int i = 0; i < kSpreadRings; ++i) {
    const std::vector<double> before = share;
    for (std::size_t v = 0; v < share.size(); ++v)
      for (const std::uint32_t other : rings[v]) share[v] = std::max(share[v], 0.5 * before[other]);
  }
}

// Moves each vertex towards the centre of its neighbours by its weight.
void smoothOnce(const std::vector<Ring>& rings, const std::vector<double>& share,
                std::vector<Vec3d>& points) {
  const std::vector<Vec3d> before = points;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (share[v] == 0) continue;
    Vec3d sum;
    for (const std::uint32_t other : rings[v]) sum = sum + before[other];
    const Vec3d middle = (1.0 / static_cast<double>(rings[v].size())) * sum;
    points[v] = before[v] + 0.5 * share[v] * (middle - before[v]);
  }
}

}  // namespace

std::optional<Fold> foldIn(const SurfaceBeat& beat, const std::vector<Face>& faces) {
  std::optional<Fold> first;
  FoldFinder(faces).look(beat, [&](std::size_t keyframe, std::size_t face) {
    first = {keyframe, face};
    return false;
  });
  return first;
}

std::optional<Fold> unfold(const SurfaceBeat& beat, const std::vector<Face>& faces) {
  constexpr int kRounds = 60, kSteps = 3;  // a round that smooths too little is followed by another
  FoldFinder finder(faces);
  const std::vector<Ring> rings = ringsOf(beat.points.front().size(), faces);
  std::vector<double> share(beat.points.front().size(), 0);
  for (int round = 0; round < kRounds; ++round) {
    bool sound = true;
    finder.look(beat, [&](std::size_t, std::size_t face) {
      for (const std::uint32_t vertex : faces[face]) share[vertex] = 1;
      sound = false;
      return true;
    });
    if (sound) return std::nullopt;
    spread(rings, share);
    for (std::vector<Vec3d>& points : beat.points)
      for (int step = 0; step < kSteps; ++step) smoothOnce(rings, share, points);
  }
  return foldIn(beat, faces);
}

}  // namespace echocine::heart
