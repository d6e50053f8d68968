#include "motion/views/contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace echocine {

namespace {

Vec3d nearestOnSegment(Vec3d p, Vec3d a, Vec3d b) {
  const Vec3d along = b - a;
  const double squared = dot(along, along);
  return squared > 0 ? a + std::clamp(dot(p - a, along) / squared, 0.0, 1.0) * along : a;
}

double distanceTo(const Facet& f, Vec3d p) {
  const Vec3d normal = cross(f[1] - f[0], f[2] - f[0]);
  const double size = length(normal);
  bool above = size > 0;
  for (std::size_t k = 0; k < 3 && above; ++k)
    above = dot(cross(f[(k + 1) % 3] - f[k], p - f[k]), normal) >= 0;
  if (above) return std::abs(dot(p - f[0], normal)) / size;
  double least = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < 3; ++k)
    least = std::min(least, length(p - nearestOnSegment(p, f[k], f[(k + 1) % 3])));
  return least;
}

// Distances to a surface by a tree of balls around its facets.
class Distances {
 public:
  explicit Distances(std::span<const Facet> facets) : facets_(facets.begin(), facets.end()) {
    build(0, facets_.size());
  }

  // At most `most`.
  double to(Vec3d p, double most) const {
    if (least(0, p) < most) look(0, p, most);
    return most;
  }

 private:
  struct Node {
    Vec3d centre;
    double radius;
    std::size_t begin, end, second;  // second: the node of the upper half; 0 in a leaf
  };
  static constexpr std::size_t kLeaf = 6;

  void build(std::size_t begin, std::size_t end) {
    const std::size_t node = nodes_.size();
    const std::span<Facet> all(&facets_[begin], end - begin);
    Vec3d low = all.front()[0], high = low;
    for (const Facet& f : all)
      for (const Vec3d p : f) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
    const Vec3d centre = 0.5 * (low + high), size = high - low;
    nodes_.push_back({centre, farthestFrom(all, centre), begin, end, 0});
    if (all.size() <= kLeaf) return;
    const Vec3d along = size.x >= size.y && size.x >= size.z ? Vec3d{1, 0, 0}
                        : size.y >= size.z                   ? Vec3d{0, 1, 0}
                                                             : Vec3d{0, 0, 1};
    const auto place = [&](const Facet& f) { return dot(f[0] + f[1] + f[2], along); };
    const std::size_t half = all.size() / 2;
    std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(half), all.end(),
                     [&](const Facet& a, const Facet& b) { return place(a) < place(b); });
    build(begin, begin + half);
    nodes_[node].second = nodes_.size();
    build(begin + half, end);
  }

  double least(std::size_t node, Vec3d p) const {
    return length(p - nodes_[node].centre) - nodes_[node].radius;
  }

  void look(std::size_t number, Vec3d p, double& nearest) const {
    const Node& node = nodes_[number];
    if (node.second == 0) {
      for (std::size_t f = node.begin; f < node.end; ++f)
        nearest = std::min(nearest, distanceTo(facets_[f], p));
      return;
    }
    std::size_t first = number + 1, then = node.second;
    if (least(then, p) < least(first, p)) std::swap(first, then);
    if (least(first, p) < nearest) look(first, p, nearest);
    if (least(then, p) < nearest) look(then, p, nearest);
  }

  Facets facets_;
  std::vector<Node> nodes_;
};

using Heights = std::array<double, 3>;

// Distances of the corners of `a` from `b`, exact up to the smallest of all plus `margin` and for
// facets that reach there; lowers `gap` to the smallest.
std::vector<Heights> distancesOf(std::span<const Facet> a, std::span<const Facet> b, double margin,
                                 double& gap) {
  const Distances distances(b);
  std::vector<Heights> apart;
  for (const Facet& f : a) {
    const double edge = std::max({length(f[1] - f[0]), length(f[2] - f[1]), length(f[0] - f[2])});
    const double most = gap + margin + edge;
    apart.push_back({distances.to(f[0], most), distances.to(f[1], most), distances.to(f[2], most)});
    for (const double d : apart.back()) gap = std::min(gap, d);
  }
  return apart;
}

void addNear(std::span<const Facet> surface, const std::vector<Heights>& apart, double most,
             Facets& near) {
  for (std::size_t i = 0; i < surface.size(); ++i)
    addPartAbove(surface[i], {most - apart[i][0], most - apart[i][1], most - apart[i][2]}, near);
}

}  // namespace

Contact contactOf(std::span<const Facet> a, std::span<const Facet> b, double margin) {
  Contact contact{{}, std::numeric_limits<double>::max()};
  const std::vector<Heights> of_a = distancesOf(a, b, margin, contact.gap),
                             of_b = distancesOf(b, a, margin, contact.gap);
  Facets near;
  addNear(a, of_a, contact.gap + margin, near);
  addNear(b, of_b, contact.gap + margin, near);
  contact.middle = middleOf(near);
  return contact;
}

}  // namespace echocine
