#include "motion/heart/unfold.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace echocine::heart {
namespace {

// The neighbours of each vertex of a closed surface, in one array.
struct Rings {
  Rings(std::size_t count, const std::vector<Face>& faces) : first(count + 1, 0) {
    for (const Face& face : faces)  // each edge runs once in either direction
      for (const std::uint32_t v : face) ++first[v + 1];
    for (std::size_t v = 0; v < count; ++v) first[v + 1] += first[v];
    others.resize(first.back());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (const Face& face : faces)
      for (std::size_t k = 0; k < 3; ++k) others[next[face[k]]++] = face[(k + 1) % 3];
  }
  std::span<const std::uint32_t> of(std::size_t v) const {
    return std::span(others).subspan(first[v], first[v + 1] - first[v]);
  }
  std::vector<std::uint32_t> first, others;
};

// Spreads weights to neighbours, halved with each ring of vertices.
void spread(const Rings& rings, std::vector<double>& share) {
  constexpr int kSpreadRings = 3;
  for (int i = 0; i < kSpreadRings; ++i) {
    const std::vector<double> before = share;
    for (std::size_t v = 0; v < share.size(); ++v)
      for (const std::uint32_t other : rings.of(v))
        share[v] = std::max(share[v], 0.5 * before[other]);
  }
}

// Moves each vertex towards the centre of its neighbours by its weight. Precondition: both have the
// same vertices wherever the weight is 0.
void smoothOnce(const Rings& rings, const std::vector<double>& share, const BeatRows& before,
                BeatRows& after) {
  for (std::size_t v = 0; v < share.size(); ++v) {
    if (share[v] == 0) continue;
    const std::span<const std::uint32_t> ring = rings.of(v);
    const double mean = 1.0 / static_cast<double>(ring.size()), weight = 0.5 * share[v];
    for (std::size_t i = 0; i < before.vertexSize(); i += kDoubleLanes) {
      Doubles4 sum{};
      for (const std::uint32_t other : ring) sum += lanesAt(before.vertex(other) + i);
      const Doubles4 own = lanesAt(before.vertex(v) + i);
      store(own + weight * (mean * sum - own), after.vertex(v) + i);
    }
  }
}

}  // namespace

Folds::Folds(const SurfaceBeat& beat, const std::vector<Face>& faces)
    : beat_(beat),
      faces_(faces),
      rows_(beat.points),
      finder_(beat.phases.first(beat.points.size()), faces) {}

std::optional<Fold> Folds::first() {
  std::optional<Fold> fold;
  finder_.look(rows_, [&](std::size_t keyframe, std::size_t face) {
    fold = {keyframe, face};
    return false;
  });
  return fold;
}

std::optional<Fold> Folds::smooth() {
  constexpr int kRounds = 60, kSteps = 3;  // a round that smooths too little is followed by another
  const std::size_t count = beat_.points.front().size();
  const Rings rings(count, faces_);
  std::vector<double> share(count, 0);
  BeatRows other = rows_;
  bool sound = false;
  for (int round = 0; round < kRounds && !sound; ++round) {
    sound = true;
    finder_.look(rows_, [&](std::size_t, std::size_t face) {
      for (const std::uint32_t vertex : faces_[face]) share[vertex] = 1;
      sound = false;
      return true;
    });
    if (sound) break;
    spread(rings, share);
    for (int step = 0; step < kSteps; ++step) {
      smoothOnce(rings, share, rows_, other);
      std::swap(rows_, other);
    }
  }
  for (std::size_t k = 0; k < beat_.points.size(); ++k)
    for (std::size_t v = 0; v < count; ++v) beat_.points[k][v] = rows_.at(v, k);
  return sound ? std::nullopt : first();
}

}  // namespace echocine::heart
