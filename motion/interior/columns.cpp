#include "motion/interior/columns.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

int binOf(double value, double lo, double hi, int bins) {
  const double at = (value - lo) / std::max(hi - lo, 1e-12) * bins;
  return std::clamp(static_cast<int>(at), 0, bins - 1);
}

}  // namespace

Columns::Columns(std::span<const Triangle> triangles, std::span<const Vec3f> positions_m)
    : triangles_(triangles.begin(), triangles.end()) {
  positions_m_.reserve(positions_m.size());
  for (const Vec3f p : positions_m) positions_m_.push_back(toDouble(p));
  for (const Triangle& t : triangles_)
    for (const std::uint32_t v : t) box_m_.add(positions_m_[v]);
  fillBins();
}

// Bins about as many as triangles along both sides of the surface's shadow on x = 0: a few
// triangles each. Two passes: count, then fill.
void Columns::fillBins() {
  bins_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(triangles_.size()))), 1, 256);
  starts_.assign(static_cast<std::size_t>(bins_) * static_cast<std::size_t>(bins_) + 1, 0);
  const auto forBins = [&](const Triangle& t, const auto& visit) {
    Box box;
    for (const std::uint32_t v : t) box.add(positions_m_[v]);
    const int y1 = binAlongY(box.hi.y), z0 = binAlongZ(box.lo.z), z1 = binAlongZ(box.hi.z);
    for (int y = binAlongY(box.lo.y); y <= y1; ++y)
      for (int z = z0; z <= z1; ++z) visit(static_cast<std::size_t>(y * bins_ + z));
  };
  for (const Triangle& t : triangles_) forBins(t, [&](std::size_t b) { ++starts_[b + 1]; });
  for (std::size_t b = 1; b < starts_.size(); ++b) starts_[b] += starts_[b - 1];
  members_.resize(starts_.back());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  for (std::uint32_t i = 0; i < triangles_.size(); ++i)
    forBins(triangles_[i],
            [&, member = memberOf(i)](std::size_t b) { members_[next[b]++] = member; });
}

// Wider by more than floats of a heart's size round.
Columns::Member Columns::memberOf(std::uint32_t triangle) const {
  Box box;
  for (const std::uint32_t v : triangles_[triangle]) box.add(positions_m_[v]);
  const double size_m = std::max({std::abs(box.lo.x), std::abs(box.hi.x), std::abs(box.lo.y),
                                  std::abs(box.hi.y), std::abs(box.lo.z), std::abs(box.hi.z)});
  const double wider_m = 1e-6 * size_m;
  const auto below = [&](double m) { return static_cast<float>(m - wider_m); };
  const auto above = [&](double m) { return static_cast<float>(m + wider_m); };
  return {below(box.lo.x), above(box.hi.x), below(box.lo.y), above(box.hi.y),
          below(box.lo.z), above(box.hi.z), triangle};
}

int Columns::binAlongY(double y) const {
  return binOf(y, box_m_.lo.y, box_m_.hi.y, bins_);
}
int Columns::binAlongZ(double z) const {
  return binOf(z, box_m_.lo.z, box_m_.hi.z, bins_);
}

std::span<const Columns::Member> Columns::bin(int y, int z) const {
  const auto b = static_cast<std::size_t>(y * bins_ + z);
  return std::span(members_).subspan(starts_[b], starts_[b + 1] - starts_[b]);
}

std::span<const Columns::Member> Columns::bin(double y, double z) const {
  if (y < box_m_.lo.y || y > box_m_.hi.y || z < box_m_.lo.z || z > box_m_.hi.z) return {};
  return bin(binAlongY(y), binAlongZ(z));
}

bool Columns::mayPass(const Box& box_m) const {
  if (!box_m_.meets(box_m)) return false;
  const Vec3f lo = toFloat(box_m.lo), hi = toFloat(box_m.hi);
  const int y1 = binAlongY(box_m.hi.y), z1 = binAlongZ(box_m.hi.z);
  for (int y = binAlongY(box_m.lo.y); y <= y1; ++y)
    for (int z = binAlongZ(box_m.lo.z); z <= z1; ++z)
      for (const Member& m : bin(y, z))
        if (m.lo_x <= hi.x && m.hi_x >= lo.x && m.lo_y <= hi.y && m.hi_y >= lo.y &&
            m.lo_z <= hi.z && m.hi_z >= lo.z)
          return true;
  return false;
}

Columns::Cut Columns::cutEdge(std::uint32_t a, std::uint32_t b, double y) const {
  const Vec3d &p = positions_m_[std::min(a, b)], &q = positions_m_[std::max(a, b)];
  const double s = (y - p.y) / (q.y - p.y);
  return {p.x + s * (q.x - p.x), p.z + s * (q.z - p.z)};
}

// The plane at height y cuts the triangle from one of its edges to another; both neighbours of an
// edge compute the same cut, so a closed surface's cuts are closed loops, and a loop changes
// between z and beyond an even number of times.
bool Columns::cross(const Triangle& t, double y, double z, Crossing& out) const {
  const bool above[3] = {positions_m_[t[0]].y >= y, positions_m_[t[1]].y >= y,
                         positions_m_[t[2]].y >= y};
  if (above[0] == above[1] && above[1] == above[2]) return false;
  const std::size_t k = above[1] == above[2] ? 0 : above[0] == above[2] ? 1 : 2;
  Cut from = cutEdge(t[k], t[(k + 1) % 3], y), to = cutEdge(t[k], t[(k + 2) % 3], y);
  if (!above[k]) std::swap(from, to);
  if ((from.z >= z) == (to.z >= z)) return false;
  const double s = (z - from.z) / (to.z - from.z);
  out = {from.x + s * (to.x - from.x), from.z >= z ? -1 : 1};
  return true;
}

void Columns::crossings(double y, double z, std::vector<Crossing>& out) const {
  out.clear();
  Crossing crossing{};
  const float y_near = static_cast<float>(y), z_near = static_cast<float>(z);
  for (const Member& m : bin(y, z))
    if (m.mayCross(m.lo_x, y_near, z_near) && cross(triangles_[m.triangle], y, z, crossing))
      out.push_back(crossing);
  std::sort(out.begin(), out.end(), [](const Crossing& a, const Crossing& b) {
    return a.x < b.x || (a.x == b.x && a.change < b.change);
  });
}

bool Columns::contains(Vec3d p) const {
  if (!box_m_.contains(p)) return false;
  int winding = 0;
  Crossing crossing{};
  const Vec3f near = toFloat(p);
  for (const Member& m : bin(p.y, p.z))
    if (m.mayCross(near.x, near.y, near.z) && cross(triangles_[m.triangle], p.y, p.z, crossing) &&
        crossing.x <= p.x)
      winding += crossing.change;
  return winding > 0;
}

}  // namespace echocine
