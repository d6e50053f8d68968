#include "motion/keyframes/keyframe_pair.h"

#include <algorithm>
#include <cmath>

#include "motion/mesh/edge_sides.h"
#include "motion/mesh/surface_measure.h"

namespace echocine {

namespace {

// Normals of triangles with a height below this fraction of their longest side are rounding, not
// shape: single precision resolves 1e-8 m, a side has about 1e-3 m. Our choice.
constexpr double kSliver = 1e-3;
constexpr float kFoldedCosine = -0.8660254f;  // 150 degrees between normals; our choice

double longestSideSquared(const Triangle& t, const std::vector<Vec3f>& positions_m) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d side = toDouble(positions_m[t[(k + 1) % 3]]) - toDouble(positions_m[t[k]]);
    longest = std::max(longest, dot(side, side));
  }
  return longest;
}

}  // namespace

std::vector<Neighbours> neighboursOf(std::span<const Triangle> triangles) {
  const std::vector<Side> sides = sortedSides(triangles);
  std::vector<Neighbours> neighbours;
  neighbours.reserve(sides.size() / 2);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i)
    if (sides[i].key == sides[i + 1].key)
      neighbours.push_back({sides[i].triangle(), sides[i + 1].triangle()});
  return neighbours;
}

KeyframePair::KeyframePair(const ControlMotion& motion, const std::vector<Neighbours>& neighbours,
                           std::size_t left, std::size_t right)
    : motion_(motion),
      left_(left),
      right_(right),
      left_sides_(sidesOf(left)),
      right_sides_(sidesOf(right)),
      is_broken_(motion.triangles.size(), false) {
  if (motion.membrane) return;
  for (const Neighbours& n : neighbours) {
    const float in_left = dot(left_sides_.normal[n.a], left_sides_.normal[n.b]);
    const float in_right = dot(right_sides_.normal[n.a], right_sides_.normal[n.b]);
    if (in_left > 0 || in_right > 0)
      open_edges_.push_back({n, in_left > 0, std::min(in_left, in_right) < kFoldedCosine});
  }
}

// One pass over a surface. The volume is V = 1/6 sum a . n over a corner a and the doubled area n
// of each triangle, relative to a vertex, so that distant coordinates do not cancel.
void KeyframePair::measure(const std::vector<Vec3f>& positions_m, Sides& sides) const {
  const std::size_t count = motion_.triangles.size();
  sides.normal.resize(count);
  sides.double_area_m2.resize(count);
  const Vec3d reference = toDouble(positions_m[motion_.triangles.front()[0]]);
  double volumes = 0, areas = 0;
  for (std::size_t t = 0; t < count; ++t) {
    const Triangle& triangle = motion_.triangles[t];
    const Vec3d area = doubleArea(triangle, positions_m);
    const double size = length(area);
    volumes += dot(toDouble(positions_m[triangle[0]]) - reference, area);
    areas += size;
    sides.normal[t] = size > 0 ? toFloat((1 / size) * area) : Vec3f{};
    sides.double_area_m2[t] = size;
  }
  sides.size = motion_.membrane ? areas / 2 : volumes / 6;
}

KeyframePair::Sides KeyframePair::sidesOf(std::size_t keyframe) const {
  const std::vector<Vec3f>& positions_m = motion_.rows_m[keyframe];
  Sides sides;
  measure(positions_m, sides);
  for (std::size_t t = 0; t < motion_.triangles.size(); ++t) {
    if (sides.double_area_m2[t] > kSliver * longestSideSquared(motion_.triangles[t], positions_m))
      continue;
    sides.normal[t] = {};
    sides.double_area_m2[t] = 0;
  }
  return sides;
}

void KeyframePair::look(const FramePhase& at, SurfaceBreaks& breaks) {
  thread_local std::vector<Vec3f> positions_m;
  thread_local Sides sides;
  motion_.at(at.phase, positions_m);
  measure(positions_m, sides);
  lookAtTriangles(at, sides, breaks);
  lookAtEdges(at, sides, breaks);
  lookAtSize(at, sides.size, breaks);
}

void KeyframePair::note(const FramePhase& at, std::uint32_t triangle, TriangleBreak kind,
                        SurfaceBreaks& breaks) {
  is_broken_[triangle] = true;
  const std::optional<SurfaceBreaks::First>& first = breaks.first;
  if (!first || at.frame < first->frame || (at.frame == first->frame && triangle < first->triangle))
    breaks.first = {{at.frame, left_, right_}, triangle, kind};
}

void KeyframePair::lookAtTriangles(const FramePhase& at, const Sides& sides,
                                   SurfaceBreaks& breaks) {
  for (std::uint32_t t = 0; t < motion_.triangles.size(); ++t) {
    const double given = std::min(left_sides_.double_area_m2[t], right_sides_.double_area_m2[t]);
    if (sides.double_area_m2[t] < kVanishedShare * given)
      note(at, t, TriangleBreak::vanished, breaks);
    else if (!motion_.membrane && dot(sides.normal[t], left_sides_.normal[t]) < 0 &&
             dot(sides.normal[t], right_sides_.normal[t]) < 0)
      note(at, t, TriangleBreak::turned, breaks);
  }
}

// If two triangles are folded onto each other, the inverted one has a direction that differs from
// the keyframe in which they are unfolded. A vanishing triangle may have any direction.
void KeyframePair::lookAtEdges(const FramePhase& at, const Sides& sides, SurfaceBreaks& breaks) {
  for (const OpenEdge& edge : open_edges_) {
    const std::uint32_t a = edge.triangles.a, b = edge.triangles.b;
    if (!(dot(sides.normal[a], sides.normal[b]) < kFoldedCosine)) continue;
    const Sides& open = edge.open_in_left ? left_sides_ : right_sides_;
    const auto remains = [&](std::uint32_t t) {
      return sides.double_area_m2[t] >= kVanishedShare * open.double_area_m2[t];
    };
    if (!remains(a) || !remains(b)) continue;
    const bool is_a = dot(sides.normal[a], open.normal[a]) < dot(sides.normal[b], open.normal[b]);
    note(at, is_a ? a : b, edge.folded_in_other ? TriangleBreak::mirrored : TriangleBreak::turned,
         breaks);
  }
}

void KeyframePair::lookAtSize(const FramePhase& at, double size, SurfaceBreaks& breaks) const {
  const double given = std::min(left_sides_.size, right_sides_.size);
  const SurfaceBreaks::Size found{
      {at.frame, left_, right_}, given > 0 ? size / given : 1, motion_.membrane ? 0 : size};
  if (!motion_.membrane && !(size > 0) &&
      (!breaks.inside_out || at.frame < breaks.inside_out->frame))
    breaks.inside_out = found;
  if (found.share < (breaks.collapsed ? breaks.collapsed->share : kCollapsedShare))
    breaks.collapsed = found;
  if (!motion_.membrane) lookAtRange(at, size, breaks);
}

void KeyframePair::lookAtRange(const FramePhase& at, double volume_m3,
                               SurfaceBreaks& breaks) const {
  const auto [least, most] = std::minmax(left_sides_.size, right_sides_.size);
  const double beyond_m3 = volume_m3 - std::clamp(volume_m3, least, most);
  if (beyond_m3 == 0) return;
  if (!breaks.overshoot || std::abs(beyond_m3) > std::abs(breaks.overshoot->beyond_m3))
    breaks.overshoot = {{at.frame, left_, right_}, at.phase, beyond_m3};
}

}  // namespace echocine
