#include "truth/orifice.h"

#include <algorithm>
#include <map>

namespace echocine {

Orifice::Orifice(std::span<const Triangle> triangles, std::span<const std::uint32_t> vertices) {
  std::vector<bool> within;
  for (const std::uint32_t v : vertices) {
    if (within.size() <= v) within.resize(v + 1, false);
    within[v] = true;
  }
  const auto isWithin = [&](std::uint32_t v) { return v < within.size() && within[v]; };
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;  // an edge of the rim has one
  for (const Triangle& t : triangles)
    if (std::all_of(t.begin(), t.end(), isWithin))
      for (std::size_t i = 0; i < 3; ++i) ++uses[std::minmax(t[i], t[(i + 1) % 3])];
  for (const auto& [edge, count] : uses)
    if (count == 1) rim_.push_back(edge);
}

// By length, so that places where the mesh is fine do not count for more.
Vec3d Orifice::middle(std::span<const Vec3f> positions_m) const {
  Vec3d sum;
  double total_m = 0;
  for (const auto& [a, b] : rim_) {
    const Vec3d p = toDouble(positions_m[a]), q = toDouble(positions_m[b]);
    const double length_m = length(q - p) + 1e-12;
    sum = sum + 0.5 * length_m * (p + q);
    total_m += length_m;
  }
  return (1 / total_m) * sum;
}

std::uint32_t Orifice::farthest(std::span<const Vec3f> positions_m, Vec3d direction) const {
  const auto along = [&](std::uint32_t v) { return dot(toDouble(positions_m[v]), direction); };
  std::uint32_t best = rim_.front().first;
  for (const auto& [a, b] : rim_)
    for (const std::uint32_t v : {a, b})
      if (along(v) > along(best)) best = v;
  return best;
}

std::optional<std::pair<Vec3d, Vec3d>> Orifice::hinges(std::span<const Vec3f> positions_m) const {
  std::vector<Vec3d> cuts;
  for (const auto& [a, b] : rim_) {
    const Vec3d p = toDouble(positions_m[a]), q = toDouble(positions_m[b]);
    if ((p.y >= 0) == (q.y >= 0)) continue;
    Vec3d cut = p + (p.y / (p.y - q.y)) * (q - p);
    cut.y = 0;
    cuts.push_back(cut);
  }
  std::optional<std::pair<Vec3d, Vec3d>> found;
  double widest_m = 0;
  for (const Vec3d& p : cuts)
    for (const Vec3d& q : cuts)
      if (p.x <= q.x && length(q - p) > widest_m) {
        widest_m = length(q - p);
        found = std::pair(p, q);
      }
  return found;
}

}  // namespace echocine
