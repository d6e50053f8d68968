#include "trace/edge_clips.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rough_angle.h"

#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// roughAngle() of four points, to kRough.
constexpr double kRough = 2e-5;  // rad
Doubles4 roughAngles(Doubles4 x, Doubles4 z) {
  const Doubles4 ax = magnitude(x), az = magnitude(z);
  const Doubles4 large = larger(ax, az), small = smaller(ax, az);
  const Doubles4 angle = roughArctangent(small / larger(large, kTiny));
  const Doubles4 ahead = ax > az ? std::numbers::pi / 2 - angle : angle;
  const Doubles4 to_x = z < 0 ? std::numbers::pi - ahead : ahead;
  return x < 0 ? -to_x : to_x;
}

}  // namespace

EdgeClipper::EdgeClipper(const Probe& probe, std::span<const ContourEdge> edges)
    : edges_(edges),
      angular_(ScanGeometry(probe).angular()),
      full_turn_(probe.isFullTurn()),
      lines_(probe.lines),
      first_(ScanGeometry(probe).firstPlace()),
      width_(ScanGeometry(probe).cellWidth()),
      per_width_(1 / width_),
      unsure_(angular_ ? kRough * per_width_ : 1e-6) {
  for (int i = 0; i <= lines_; ++i) {
    const double at = ScanGeometry(probe).cellBorder(i);
    boundaries_.push_back(angular_ ? Boundary{std::sin(at), std::cos(at)} : Boundary{at, 1});
  }
  if (full_turn_) boundaries_.back() = boundaries_.front();
}

void EdgeClipper::next(EdgeClips& clips) {
  clips.count = 0;
  while (clips.count < kClips) {
    if (ends_.done == ends_.count) {
      if (taken_ == edges_.size()) break;
      takeEnds();
      findCells();
    }
    intoCells(clips);
  }
  cutAtBoundaries(clips);
}

void EdgeClipper::takeOne(Vec3d a, Vec3d b) {
  const std::size_t n = ends_.count++;
  ends_.a_x[n] = a.x;
  ends_.a_z[n] = a.z;
  ends_.b_x[n] = b.x;
  ends_.b_z[n] = b.z;
  ends_.edge[n] = static_cast<std::uint32_t>(taken_);
}

// The part in front of the transducer: lines of a sector never point backwards, so a part behind
// z = 0 is in no cell.
void EdgeClipper::takeOneAhead(Vec3d a, Vec3d b) {
  if (a.z < 0 && b.z < 0) return;
  if (a.z < 0 || b.z < 0) {
    Vec3d& behind = a.z < 0 ? a : b;
    behind.x = a.x + (b.x - a.x) * (a.z / (a.z - b.z));
    behind.z = 0;
  }
  takeOne(a, b);
}

// An edge over more than a right angle becomes two, divided at the place nearest to the centre:
// within each part, the sign of the sine tells which side of a boundary a place lies on.
void EdgeClipper::takeOneAround(Vec3d a, Vec3d b) {
  if (a.x * b.x + a.z * b.z >= 0) return takeOne(a, b);
  const double dx = b.x - a.x, dz = b.z - a.z;
  const double t = -(a.x * dx + a.z * dz) / (dx * dx + dz * dz);
  const Vec3d nearest{a.x + t * dx, 0, a.z + t * dz};
  takeOne(a, nearest);
  takeOne(nearest, b);
}

void EdgeClipper::takeEnds() {
  ends_.count = ends_.done = 0;
  const std::size_t most_of_edge = full_turn_ ? 2 : 1;
  for (; taken_ < edges_.size() && ends_.count + most_of_edge <= kEdges; ++taken_) {
    const Vec3d a = edges_[taken_].cut.from, b = edges_[taken_].cut.to;
    full_turn_ ? takeOneAround(a, b) : takeOneAhead(a, b);
  }
}

// How many boundaries a point has on its left or on it, by and large.
Doubles4 EdgeClipper::placeOf(Doubles4 x, Doubles4 z) const {
  const Doubles4 place = angular_ ? roughAngles(x, z) : x;
  return clamped((place - first_) * per_width_ + 1.5, Doubles4{}, Doubles4{} + (lines_ + 1.0));
}

// The cells that hold the ends; -1 left of the first and the number of lines right of the last.
// Only what lies close to a boundary needs the boundary itself.
void EdgeClipper::findCells() {
  const auto cells = [&](const double* x, const double* z, std::int32_t* out) {
    const Doubles4 place = placeOf(lanesAt(x), lanesAt(z));
    const Ints4 guess = __builtin_convertvector(place, Ints4);
    const Ints4 cell = guess - 1;
    store(cell, out);
    const Doubles4 beyond = place - __builtin_convertvector(guess, Doubles4);
    if (!any((beyond < unsure_) | (beyond > 1 - unsure_))) return;
    for (std::size_t j = 0; j < kDoubleLanes; ++j) out[j] = cellOf(x[j], z[j], guess[j]);
  };
  for (std::size_t i = 0; i < ends_.count; i += kDoubleLanes) {
    cells(&ends_.a_x[i], &ends_.a_z[i], &ends_.begin[i]);
    cells(&ends_.b_x[i], &ends_.b_z[i], &ends_.end[i]);
  }
  const auto swapEnds = [&](std::size_t i) {
    std::swap(ends_.a_x[i], ends_.b_x[i]);
    std::swap(ends_.a_z[i], ends_.b_z[i]);
    std::swap(ends_.begin[i], ends_.end[i]);
  };
  for (std::size_t i = 0; i < ends_.count; ++i) {
    if (full_turn_) {
      // The short way round from begin to end.
      ends_.begin[i] = (ends_.begin[i] + lines_) % lines_;
      ends_.end[i] = (ends_.end[i] + lines_) % lines_;
      if ((ends_.end[i] - ends_.begin[i] + lines_) % lines_ > lines_ / 2) swapEnds(i);
      if (ends_.end[i] < ends_.begin[i]) ends_.end[i] += lines_;
      continue;
    }
    if (ends_.begin[i] > ends_.end[i]) swapEnds(i);
    ends_.begin[i] = std::max(ends_.begin[i], 0);
    ends_.end[i] = std::min(ends_.end[i], lines_ - 1);
  }
}

// How far a point lies to the right of a boundary between cells.
Doubles4 EdgeClipper::rightOf(Doubles4 x, Doubles4 z, Doubles4 sine, Doubles4 cosine) const {
  return angular_ ? x * cosine - z * sine : x - sine;
}
double EdgeClipper::rightOf(double x, double z, int boundary) const {
  const Boundary& at = boundaries_[static_cast<std::size_t>(boundary)];
  return angular_ ? x * at.cosine - z * at.sine : x - at.sine;
}

int EdgeClipper::cellOf(double x, double z, int guess) const {
  if (full_turn_) {  // the cell before the guess, the guess, or the one behind
    const int cell = (guess - 1 + lines_) % lines_;
    if (rightOf(x, z, cell) < 0) return (cell - 1 + lines_) % lines_;
    return rightOf(x, z, cell + 1) >= 0 ? (cell + 1) % lines_ : cell;
  }
  int n = guess;
  while (n <= lines_ && rightOf(x, z, n) >= 0) ++n;
  while (n > 0 && rightOf(x, z, n - 1) < 0) --n;
  return n - 1;
}

// Puts edges into their cells, as long as there is room; they are cut later.
void EdgeClipper::intoCells(EdgeClips& clips) {
  std::size_t clip = clips.count;
  for (; ends_.done < ends_.count && clip < kClips; ++ends_.done) {
    const std::size_t i = ends_.done;
    std::int32_t cell = ends_.begin[i];
    const std::int32_t end = std::min(ends_.end[i] + 1, cell + static_cast<int>(kClips - clip));
    if (cell >= end) continue;
    const ContourEdge& edge = edges_[ends_.edge[i]];
    Vec3d normal = edge.area_normal;
    double normal_square = dot(normal, normal);
    if (!(normal_square > 0)) {
      normal = unitNormal(edge);
      normal_square = 1;
    }
    for (; cell < end; ++cell, ++clip) {
      const int line = cell < lines_ ? cell : cell - lines_;
      const Boundary* side = &boundaries_[static_cast<std::size_t>(line)];
      clips.a_x[clip] = ends_.a_x[i];
      clips.a_z[clip] = ends_.a_z[i];
      clips.b_x[clip] = ends_.b_x[i];
      clips.b_z[clip] = ends_.b_z[i];
      sides_.left_sine[clip] = side[0].sine;
      sides_.left_cosine[clip] = side[0].cosine;
      sides_.right_sine[clip] = side[1].sine;
      sides_.right_cosine[clip] = side[1].cosine;
      clips.normal_x[clip] = normal.x;
      clips.normal_y[clip] = normal.y;
      clips.normal_z[clip] = normal.z;
      clips.normal_square[clip] = normal_square;
      clips.edge[clip] = ends_.edge[i];
      clips.line[clip] = static_cast<std::uint32_t>(line);
    }
    ends_.begin[i] = cell;
    if (cell <= ends_.end[i]) break;  // no room for the rest
  }
  clips.count = clip;
}

// Where an edge hits a boundary its ends lie on both sides, a left and b right or on it. Else a
// is right of the left boundary or b left of the right one, and the clamps leave the end where it
// is, whichever of both is the more to the right.
void EdgeClipper::cutAtBoundaries(EdgeClips& clips) const {
  for (std::size_t i = 0; i < clips.count; i += kDoubleLanes) {
    const Doubles4 a_x = lanesAt(&clips.a_x[i]), a_z = lanesAt(&clips.a_z[i]),
                   b_x = lanesAt(&clips.b_x[i]), b_z = lanesAt(&clips.b_z[i]);
    const Doubles4 dx = b_x - a_x, dz = b_z - a_z;
    const auto at = [&](const double* sines, const double* cosines) {
      const Doubles4 sine = lanesAt(sines), cosine = lanesAt(cosines);
      const Doubles4 u_a = rightOf(a_x, a_z, sine, cosine), u_b = rightOf(b_x, b_z, sine, cosine);
      return clamped(-u_a / larger(u_b - u_a, kTiny), Doubles4{}, Doubles4{} + 1);
    };
    const Doubles4 s = at(&sides_.left_sine[i], &sides_.left_cosine[i]),
                   t = at(&sides_.right_sine[i], &sides_.right_cosine[i]);
    const Mask4 whole = t >= 1;
    const Doubles4 from_x = a_x + s * dx, from_z = a_z + s * dz;
    const Doubles4 end_x = whole ? b_x : a_x + t * dx, end_z = whole ? b_z : a_z + t * dz;
    const Doubles4 clip_x = end_x - from_x, clip_z = end_z - from_z;
    const Doubles4 outward = angular_ ? from_x * clip_x + from_z * clip_z : clip_z;
    const Mask4 inward = outward < 0;
    store(inward ? end_x : from_x, &clips.a_x[i]);
    store(inward ? end_z : from_z, &clips.a_z[i]);
    store(inward ? from_x : end_x, &clips.b_x[i]);
    store(inward ? from_z : end_z, &clips.b_z[i]);
    Mask4 turns{};
    Doubles4 to_x{}, to_z = Doubles4{} + 1;
    if (angular_) {
      turns = inward & (-outward < clip_x * clip_x + clip_z * clip_z);
      const Doubles4 x = (from_x + end_x) / 2, z = (from_z + end_z) / 2;
      const Mask4 apart = (x != 0) | (z != 0);  // from the centre
      to_x = apart ? x : to_x;
      to_z = apart ? z : to_z;
    }
    store(to_x, &clips.to_x[i]);
    store(to_z, &clips.to_z[i]);
    const Mask4 entering =
        to_x * lanesAt(&clips.normal_x[i]) + to_z * lanesAt(&clips.normal_z[i]) < 0;
    store(entering, &clips.entering[i]);
    store(turns, &clips.turns[i]);
  }
}

}  // namespace echocine
