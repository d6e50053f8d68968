#include "geometry/sound_paths.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

// A place against a path in the imaging plane: the depth of the path's nearest point at the same
// range, that point, and how far the place lies to its right.
struct Beside {
  double depth_m = 0, right_m = 0;
  Vec3d on_path_m;
};

Beside besidePath(const SoundPath& path, Vec3d place_m) {
  const std::vector<SoundPath::Knot>& knots = path.knots;
  Beside found;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const Vec3d a = knots[k].place_m, along = knots[k + 1].place_m - a, to = place_m - a;
    const double square = along.x * along.x + along.z * along.z;
    const bool last = k + 2 == knots.size();
    if (!(square > 0) && !last) continue;
    const double share = square > 0 ? (to.x * along.x + to.z * along.z) / square : 0;
    if (share > 1 && !last) continue;
    const Vec3d at = a + share * along;
    const double off = (to.x * along.z - to.z * along.x) / std::sqrt(std::max(square, 1e-30));
    return {knots[k].depth_m + share * (knots[k + 1].depth_m - knots[k].depth_m), off, at};
  }
  return found;
}

}  // namespace

std::size_t SoundPath::pieceAt(double depth_m) const {
  const auto behind =
      std::upper_bound(knots.begin() + 1, knots.end() - 1, depth_m,
                       [](double depth, const Knot& knot) { return depth < knot.depth_m; });
  return static_cast<std::size_t>(behind - knots.begin()) - 1;
}

std::uint16_t SoundPath::idAt(double depth_m) const {
  const auto found =
      std::upper_bound(stretches.begin(), stretches.end(), depth_m,
                       [](double depth, const Stretch& s) { return depth < s.end_depth_m; });
  if (found != stretches.end()) return found->id;
  return stretches.empty() ? std::uint16_t{0} : stretches.back().id;
}

Vec3d SoundPaths::shownAt(std::size_t line, double depth_m) const {
  const LineGeometry geometry = lineGeometry(probe, static_cast<int>(line));
  return geometry.origin + depth_m * geometry.direction;
}

// Over a full turn, the pair around the place is found from the straight line through it, a step to
// one side after the other.
Vec3d SoundPaths::shownAround(Vec3d place_m) const {
  const auto count = static_cast<int>(paths.size());
  const auto path = [&](int i) { return static_cast<std::size_t>((i % count + count) % count); };
  const ScanGeometry geometry(probe);
  int left = static_cast<int>(geometry.beamPosition(place_m.x, place_m.z)->line);
  Beside a = besidePath(paths[path(left)], place_m);
  for (int step = 0; a.right_m < 0 && step < count / 4; ++step)
    a = besidePath(paths[path(--left)], place_m);
  Beside b = besidePath(paths[path(left + 1)], place_m);
  for (int step = 0; b.right_m > 0 && step < count / 4; ++step) {
    a = b;
    ++left;
    b = besidePath(paths[path(left + 1)], place_m);
  }
  const double apart_m = a.right_m - b.right_m;
  const double share = apart_m > 0 ? std::clamp(a.right_m / apart_m, 0.0, 1.0) : 0;
  Vec3d at = shownAt(path(left), a.depth_m);
  at = at + share * (shownAt(path(left + 1), b.depth_m) - at);
  return {at.x, place_m.y, at.z};
}

// Places to the right of a path stay there from path to path, so the pair around the place is found
// by bisection; where bent paths cross one another it is one of several.
Vec3d SoundPaths::shown(Vec3d place_m) const {
  if (probe.isFullTurn()) return shownAround(place_m);
  std::size_t left = 0, right = paths.size() - 1;
  Beside a = besidePath(paths[left], place_m), b = besidePath(paths[right], place_m);
  const auto shifted = [&](std::size_t line, const Beside& at) {
    return place_m + (shownAt(line, at.depth_m) - Vec3d{at.on_path_m.x, 0, at.on_path_m.z});
  };
  if (a.right_m <= 0 || left == right) return shifted(left, a);
  if (b.right_m >= 0) return shifted(right, b);
  while (right - left > 1) {
    const std::size_t middle = (left + right) / 2;
    const Beside at = besidePath(paths[middle], place_m);
    (at.right_m >= 0 ? left : right) = middle;
    (at.right_m >= 0 ? a : b) = at;
  }
  const double share = a.right_m / (a.right_m - b.right_m);
  Vec3d at = shownAt(left, a.depth_m);
  at = at + share * (shownAt(right, b.depth_m) - at);
  return {at.x, place_m.y, at.z};
}

SoundPaths emptyPaths(const Probe& probe, double spacing_m) {
  constexpr double kMostPerLine = 64;
  SoundPaths paths;
  paths.probe = probe;
  if (probe.lines < 2) return paths;
  const double apart = std::ceil(lineSpacing(probe, probe.max_depth_m) / spacing_m);
  paths.per_line = static_cast<int>(std::clamp(apart, 1.0, kMostPerLine));
  if (probe.isFullTurn()) {
    paths.per_line |= 1;  // odd: the scene's lines are the middle ones
    paths.probe.lines = probe.lines * paths.per_line;
  } else {
    paths.probe.lines = (probe.lines - 1) * paths.per_line + 1;
  }
  return paths;
}

}  // namespace echocine
