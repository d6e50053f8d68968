#include "truth/shown_contours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace echocine {

namespace {

constexpr std::size_t kUnjoined = std::numeric_limits<std::size_t>::max();

// Places on the paths where contours pass, and which place each is joined to on either side.
class Joins {
 public:
  explicit Joins(const SoundPaths& paths) : paths_(paths) {}

  std::size_t add(std::size_t path, double depth_m) {
    places_m_.push_back(paths_.shownAt(path, depth_m));
    next_.push_back({kUnjoined, kUnjoined});
    return places_m_.size() - 1;
  }

  // Each place takes part in one join to its left and in one to its right.
  enum Side { left, right };
  void join(std::size_t a, Side of_a, std::size_t b, Side of_b) {
    next_[a][of_a] = b;
    next_[b][of_b] = a;
  }

  // Contours in the order of their first places; open ones from an end.
  void chain(SurfaceId surface, std::vector<Contour>& contours) {
    std::vector<bool> used(places_m_.size(), false);
    for (const bool open : {true, false})
      for (std::size_t i = 0; i < places_m_.size(); ++i) {
        const bool end = next_[i][left] == kUnjoined || next_[i][right] == kUnjoined;
        if (used[i] || (open && !end)) continue;
        Contour contour = follow(i, used);
        if (contour.points_m.size() < (open ? 2 : 3)) continue;
        contour.surface = surface;
        contour.closed = !open;
        contours.push_back(std::move(contour));
      }
  }

 private:
  Contour follow(std::size_t i, std::vector<bool>& used) const {
    Contour contour;
    while (i != kUnjoined && !used[i]) {
      used[i] = true;
      contour.points_m.push_back(places_m_[i]);
      const std::size_t a = next_[i][right], b = next_[i][left];
      i = a != kUnjoined && !used[a] ? a : b;
    }
    return contour;
  }

  const SoundPaths& paths_;
  std::vector<Vec3d> places_m_;
  std::vector<std::array<std::size_t, 2>> next_;
};

// A stretch of a path within a surface, and the places where it begins and ends.
struct Inside {
  double begin_m = 0, end_m = 0;
  std::size_t begin = 0, end = 0;
};

std::vector<Inside> insideOf(const SoundPath& path, SurfaceId surface) {
  std::vector<Inside> found;
  const double end_m = path.knots.back().depth_m;
  bool inside = path.inside[index(surface)];
  double begin_m = 0;
  for (const SoundPath::Wall& wall : path.walls) {
    if (wall.surface != surface || wall.entering == inside) continue;
    if (inside) found.push_back({begin_m, wall.depth_m});
    inside = wall.entering;
    begin_m = wall.depth_m;
  }
  if (inside) found.push_back({begin_m, end_m});
  std::erase_if(found, [](const Inside& i) { return !(i.end_m > i.begin_m); });
  return found;
}

// The stretches from `a` to before `b` of one path hang together on this side: its outermost ends
// are joined elsewhere, gaps between them close.
void closeGaps(const std::vector<Inside>& on, std::size_t a, std::size_t b, Joins::Side side,
               Joins& joins) {
  for (std::size_t i = a; i + 1 < b; ++i) joins.join(on[i].end, side, on[i + 1].begin, side);
}

// Neighbouring paths: groups of stretches that overlap are one part of the structure.
void joinStretches(const std::vector<Inside>& left, const std::vector<Inside>& right,
                   Joins& joins) {
  std::size_t i = 0, j = 0;
  const auto alone = [&](const Inside& s, Joins::Side side) {
    joins.join(s.begin, side, s.end, side);
  };
  while (i < left.size() || j < right.size()) {
    if (j == right.size() || (i < left.size() && left[i].end_m <= right[j].begin_m)) {
      alone(left[i++], Joins::right);
    } else if (i == left.size() || right[j].end_m <= left[i].begin_m) {
      alone(right[j++], Joins::left);
    } else {
      const std::size_t first_i = i++, first_j = j++;
      for (bool more = true; more;) {
        const bool of_left = i < left.size() && left[i].begin_m < right[j - 1].end_m;
        const bool of_right = j < right.size() && right[j].begin_m < left[i - 1].end_m;
        if (of_left)
          ++i;
        else if (of_right)
          ++j;
        more = of_left || of_right;
      }
      joins.join(left[first_i].begin, Joins::right, right[first_j].begin, Joins::left);
      joins.join(left[i - 1].end, Joins::right, right[j - 1].end, Joins::left);
      closeGaps(left, first_i, i, Joins::right, joins);
      closeGaps(right, first_j, j, Joins::left, joins);
    }
  }
}

void addBody(const SoundPaths& paths, SurfaceId surface, std::vector<Contour>& contours) {
  Joins joins(paths);
  const bool full_turn = paths.probe.isFullTurn();
  std::vector<Inside> before, now, behind_last;
  for (std::size_t p = 0; p < paths.paths.size(); ++p) {
    now = insideOf(paths.paths[p], surface);
    for (Inside& stretch : now) {
      stretch.begin = joins.add(p, stretch.begin_m);
      stretch.end = joins.add(p, stretch.end_m);
    }
    if (full_turn && p == 0)
      behind_last = now;
    else
      joinStretches(before, now, joins);
    std::swap(before, now);
  }
  joinStretches(before, behind_last, joins);
  joins.chain(surface, contours);
}

// A crossing of a membrane.
struct Pass {
  double depth_m = 0;
  bool entering = false;
  std::size_t place = 0;
};

void joinPasses(const std::vector<Pass>& left, const std::vector<Pass>& right, const Probe& probe,
                Joins& joins) {
  constexpr double kSteepest = 10;
  struct Pair {
    double off_m;
    std::size_t i, j;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < left.size(); ++i)
    for (std::size_t j = 0; j < right.size(); ++j) {
      const double off_m = std::abs(left[i].depth_m - right[j].depth_m);
      const double apart_m = std::abs(lineSpacing(probe, right[j].depth_m));
      if (left[i].entering == right[j].entering && off_m <= kSteepest * apart_m)
        pairs.push_back({off_m, i, j});
    }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.off_m < b.off_m; });
  std::vector<bool> taken_left(left.size(), false), taken_right(right.size(), false);
  for (const Pair& pair : pairs) {
    if (taken_left[pair.i] || taken_right[pair.j]) continue;
    taken_left[pair.i] = taken_right[pair.j] = true;
    joins.join(left[pair.i].place, Joins::right, right[pair.j].place, Joins::left);
  }
}

void addSheet(const SoundPaths& paths, SurfaceId surface, std::vector<Contour>& contours) {
  Joins joins(paths);
  std::vector<Pass> before, now, first;
  for (std::size_t p = 0; p < paths.paths.size(); ++p) {
    now.clear();
    for (const SoundPath::Wall& wall : paths.paths[p].walls)
      if (wall.surface == surface)
        now.push_back({wall.depth_m, wall.entering, joins.add(p, wall.depth_m)});
    joinPasses(before, now, paths.probe, joins);
    if (p == 0) first = now;
    std::swap(before, now);
  }
  if (paths.probe.isFullTurn()) joinPasses(before, first, paths.probe, joins);
  joins.chain(surface, contours);
}

}  // namespace

std::vector<Contour> shownContours(const Scene& scene, const SoundPaths& paths) {
  std::vector<Contour> contours;
  for (std::size_t s = 0; s < scene.structures.size(); ++s)
    (scene.structures[s].membrane ? addSheet : addBody)(paths, static_cast<SurfaceId>(s), contours);
  return contours;
}

}  // namespace echocine
