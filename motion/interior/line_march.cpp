#include "motion/interior/line_march.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

// Newton's last step, in cells: what it leaves is smaller by the gradient's change along it, which
// is under 1e-4 mm. Our choice.
constexpr float kSettled = 0.005f;
// The least that a stretch advances, in steps of the line. Our choice.
constexpr float kLeastAdvance = 1.0f / 64;
// The least volume ratio of a map that is followed.
constexpr float kLeastRatio = 1e-3f;
constexpr float kNever = 1e30f;
// So near to a side, in cells, the path is taken as straight to it. Our choice: it bends by less
// than 1e-4 mm.
constexpr float kNearSide = 0.03f;
constexpr int kSideSteps = 16, kStartSteps = 20;
// A stretch that bends more, in cells, is cut. A cubic misses what bends evenly by b of its length
// by b^3 / 384 of it. Our choice: under 1e-3 mm in cells of 5 mm.
constexpr float kMostBend = 0.35f;

}  // namespace

// A place of the line a little on, as if it were straight.
void LineMarch::go(End& end, float steps) {
  end.at += steps;
  end.place += steps * end.slope;
}

LineMarch::LineMarch(const GroupFrame& now, Vec3d start_m, Vec3d step_m)
    : now_(now), counts_{now.grid.nx, now.grid.ny, now.grid.nz, 0} {
  const double per_m = 1 / static_cast<double>(now.grid.spacing_m);
  start_ = lanesOf(toFloat(per_m * (start_m - toDouble(now.grid.origin_m))));
  step_ = lanesOf(toFloat(per_m * step_m));
}

// Outside the lattice the nearest place on its border lends its displacement: cells there have the
// same node on both sides.
CellNodes LineMarch::nodes() const {
  std::size_t low[3], high[3];
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = static_cast<std::size_t>(std::max(cell_[a], 0));
    high[a] = static_cast<std::size_t>(std::min(cell_[a] + 1, counts_[a] - 1));
  }
  const LatticeGrid& grid = now_.grid;
  const auto at = [&](std::size_t y, std::size_t z) {
    return grid.at(static_cast<int>(low[0]), static_cast<int>(y), static_cast<int>(z));
  };
  return {{at(low[1], low[2]), at(low[1], high[2]), at(high[1], low[2]), at(high[1], high[2])},
          high[0] - low[0]};
}

void LineMarch::enterCell() {
  corners_ = CellCorners::of(now_.displacement_m.data(), nodes());
}

Floats4 LineMarch::inCell(const End& end) const {
  return end.place - __builtin_convertvector(cell_, Floats4);
}

// One of Newton's steps with the cell's own function, also beyond its sides, and the slope there.
// Returns how far it went, in cells; below 0 where the map turns over.
float LineMarch::settle(End& end) const {
  const float per_m = 1 / now_.grid.spacing_m;
  const CellValue d = corners_.at(inCell(end));
  const Vec3f x = vectorOf(per_m * d.along_x) + Vec3f{1, 0, 0},
              y = vectorOf(per_m * d.along_y) + Vec3f{0, 1, 0},
              z = vectorOf(per_m * d.along_z) + Vec3f{0, 0, 1};
  const Vec3f yz = cross(y, z);
  const float ratio = dot(x, yz);
  if (!(ratio > kLeastRatio)) return -1;
  const Vec3f zx = cross(z, x), xy = cross(x, y);
  const float inverse = 1 / ratio;
  // Rows of the inverse gradient are yz, zx and xy over the ratio; here as columns.
  const Floats4 columns[3] = {inverse * Floats4{yz.x, zx.x, xy.x, 0},
                              inverse * Floats4{yz.y, zx.y, xy.y, 0},
                              inverse * Floats4{yz.z, zx.z, xy.z, 0}};
  const auto solved = [&](Floats4 b) {
    return columns[0] * b[0] + columns[1] * b[1] + columns[2] * b[2];
  };
  const Floats4 by = solved(start_ + end.at * step_ - end.place - per_m * d.value);
  end.place += by;
  end.slope = solved(step_);
  return std::max({std::abs(by[0]), std::abs(by[1]), std::abs(by[2])});
}

bool LineMarch::startAt(float at, Vec3f guess_m) {
  to_ = {};
  to_.at = at;
  to_.place = lanesOf((1 / now_.grid.spacing_m) * (guess_m - now_.grid.origin_m));
  side_ = {};
  bool settled = false;
  for (int i = 0; i < kStartSteps && !settled; ++i) {
    Ints4 cell{};
    for (int a = 0; a < 3; ++a)
      cell[a] = std::clamp(static_cast<int>(std::floor(to_.place[a])), -1, counts_[a] - 1);
    const bool same = i > 0 && cell[0] == cell_[0] && cell[1] == cell_[1] && cell[2] == cell_[2];
    if (!same) {
      cell_ = cell;
      enterCell();
    }
    const Floats4 before = to_.place;
    const float went = settle(to_);
    if (went < 0) return false;
    if (went > 1) to_.place = before + (1 / went) * (to_.place - before);
    settled = went < kSettled;
  }
  from_ = to_;
  return settled;
}

// The side of the cell that a straight path goes on to meet first.
LineMarch::Side LineMarch::sideAhead(const End& end) const {
  const Ints4 up = end.slope > 0.0f;  // -1 where it goes up
  const Ints4 none = (up ? cell_ >= counts_ - 1 : cell_ < 0) | (end.slope == 0.0f);
  const Floats4 sides = __builtin_convertvector(cell_ - up, Floats4);
  const Floats4 steps = none ? Floats4{} + kNever : (sides - end.place) / end.slope;
  Side first{-1, 0, kNever};
  for (int a = 0; a < 3; ++a)
    if (steps[a] < first.steps) first = {a, cell_[a] + (up[a] != 0 ? 1 : -1), steps[a]};
  return first;
}

// How far the stretch is from straight, in cells.
float LineMarch::bend() const {
  const Floats4 by = (to_.at - from_.at) * (to_.slope - from_.slope);
  return std::max({std::abs(by[0]), std::abs(by[1]), std::abs(by[2])});
}

// The path bends, so the side that a straight one would meet is sought again from where that would
// have met it. Where it bends much the stretch is half as long.
bool LineMarch::advance(float end) {
  from_ = to_;
  if (side_.axis >= 0) {
    cell_[side_.axis] = side_.next;
    enterCell();
    if (settle(from_) < 0) return false;
    to_ = from_;
  }
  float more = std::max(sideAhead(from_).steps, kLeastAdvance);
  for (int i = 0; i < kSideSteps; ++i) {
    const float at = std::min(to_.at + more, end);
    go(to_, at - to_.at);
    to_.at = at;
    const float went = settle(to_);
    if (went < 0) return false;
    if (bend() > kMostBend) {
      end = (from_.at + at) / 2;
      more = end - at;
      continue;
    }
    side_ = sideAhead(to_);
    const bool ends = at >= end && side_.steps >= 0;
    if (ends) side_ = {};
    more = ends ? 0 : std::max(side_.steps, (from_.at - at) / 2);
    if (went < kSettled && std::abs(more * to_.slope[std::max(side_.axis, 0)]) < kNearSide) {
      go(to_, more);
      return true;
    }
  }
  return false;
}

LineValue LineMarch::movedAt(const End& end) const {
  const float spacing_m = now_.grid.spacing_m;
  return {vectorOf(spacing_m * (start_ + end.at * step_ - end.place)),
          vectorOf(spacing_m * (step_ - end.slope))};
}

LineValue LineMarch::valueAt(const CellCorners& corners, const End& end) const {
  const CellValue d = corners.at(inCell(end));
  return {vectorOf(d.value),
          vectorOf(end.slope[0] * d.along_x + end.slope[1] * d.along_y + end.slope[2] * d.along_z)};
}

LineMarch::Stretch LineMarch::in(const GroupFrame& other) const {
  const CellCorners corners = CellCorners::of(other.displacement_m.data(), nodes());
  return {valueAt(corners, from_), valueAt(corners, to_)};
}

LineMarch::Stretch LineMarch::between(const GroupFrame& before, const GroupFrame& after) const {
  const CellNodes here = nodes();
  const CellCorners corners = CellCorners::of(after.displacement_m.data(), here) -
                              CellCorners::of(before.displacement_m.data(), here);
  return {valueAt(corners, from_), valueAt(corners, to_)};
}

}  // namespace echocine
