#include "motion/heart/tube.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "motion/heart/four_points.h"
#include "motion/heart/meridian.h"
#include "motion/heart/smooth.h"

namespace echocine::heart {
namespace {

constexpr int kSections = 120, kFine = 40;
constexpr std::size_t kStretch = 8;  // sections, a multiple of four
constexpr double kFar = std::numeric_limits<double>::infinity();

Vec3d catmullRom(Vec3d a, Vec3d b, Vec3d c, Vec3d d, double t) {
  return 0.5 * (2 * b + t * (c - a) + t * t * (2 * a - 5 * b + 4 * c - d) +
                t * t * t * (3 * b - a - 3 * c + d));
}

std::vector<Tube::Station> smoothed(const std::vector<Tube::Station>& s) {
  std::vector<Tube::Station> fine;
  for (std::size_t i = 0; i + 1 < s.size(); ++i) {
    const Vec3d before = i > 0 ? s[i - 1].centre : 2 * s[0].centre - s[1].centre;
    const Vec3d after = i + 2 < s.size() ? s[i + 2].centre : 2 * s[i + 1].centre - s[i].centre;
    for (int k = 0; k < kFine; ++k) {
      const double t = double(k) / kFine;
      fine.push_back({catmullRom(before, s[i].centre, s[i + 1].centre, after, t),
                      std::lerp(s[i].radius_m, s[i + 1].radius_m, smoothStep(0, 1, t))});
    }
  }
  fine.push_back(s.back());
  return fine;
}

}  // namespace

Tube::Tube(const std::vector<Station>& stations) {
  CHECK_LE(std::size_t{3}, stations.size());
  const std::vector<Station> fine = smoothed(stations);
  std::vector<double> arc_m(fine.size(), 0);
  for (std::size_t i = 1; i < fine.size(); ++i)
    arc_m[i] = arc_m[i - 1] + length(fine[i].centre - fine[i - 1].centre);
  length_m_ = arc_m.back();
  Vec3d u{0.6, 0.64, 0.48};  // carried along without turning about the line; our choice
  for (int k = 0; k <= kSections; ++k) {
    const double want = length_m_ * k / kSections;
    const auto above = std::upper_bound(arc_m.begin() + 1, arc_m.end() - 1, want);
    const auto i = static_cast<std::size_t>(above - arc_m.begin());
    const double t = std::clamp((want - arc_m[i - 1]) / (arc_m[i] - arc_m[i - 1]), 0.0, 1.0);
    const Vec3d tangent = normalised(fine[i].centre - fine[i - 1].centre);
    u = normalised(u - dot(u, tangent) * tangent);
    sections_.push_back({fine[i - 1].centre + t * (fine[i].centre - fine[i - 1].centre), u,
                         cross(tangent, u), std::lerp(fine[i - 1].radius_m, fine[i].radius_m, t)});
  }
  for (const Section& section : sections_) {
    centres_m_.add(section.centre);
    most_radius_m_ = std::max(most_radius_m_, section.radius_m);
  }
  std::vector<Vec3d> centres, hubs;
  for (const Section& section : sections_) centres.push_back(section.centre);
  for (std::size_t first = 0; first < centres.size(); first += kStretch) {
    const std::size_t end = std::min(first + kStretch, centres.size());
    hubs.push_back(centres[(first + end) / 2]);
    for (std::size_t i = first; i < end; ++i)
      hub_reach_m_ = std::max(hub_reach_m_, length(centres[i] - hubs.back()));
  }
  fours_ = foursOf(centres);
  hubs_ = foursOf(hubs);
}

std::vector<Tube::Four> Tube::foursOf(const std::vector<Vec3d>& centres) {
  std::vector<Four> fours;
  for (std::size_t i = 0; i < centres.size(); i += 4) {
    Four& four = fours.emplace_back(Four{{kFar, kFar, kFar, kFar}, {}, {}});
    for (std::size_t lane = 0; lane < 4 && i + lane < centres.size(); ++lane) {
      four.x[lane] = centres[i + lane].x;
      four.y[lane] = centres[i + lane].y;
      four.z[lane] = centres[i + lane].z;
    }
  }
  return fours;
}

Tube::Section Tube::at(double share) const {
  const double place = std::clamp(share, 0.0, 1.0) * kSections;
  const int i = std::min(static_cast<int>(place), kSections - 1);
  const Section &a = sections_[i], &b = sections_[i + 1];
  const double t = place - i;
  return {a.centre + t * (b.centre - a.centre), a.u + t * (b.u - a.u), a.v + t * (b.v - a.v),
          std::lerp(a.radius_m, b.radius_m, t)};
}

Vec3d Tube::point(Vec3d direction, double thickness_m) const {
  // The outline walked by arc length: across the first end, along, across the last end.
  const double first_m = sections_.front().radius_m, last_m = sections_.back().radius_m;
  const double share = 1 - shareOf(direction);
  const double walked_m = share * (first_m + length_m_ + last_m);
  const double along = (walked_m - first_m) / length_m_;
  const Section section = at(along);
  double fill = 1;  // of the radius
  if (along < 0) fill = walked_m / first_m;
  if (along > 1) fill = 1 - (walked_m - first_m - length_m_) / last_m;
  const double azimuth_rad = std::atan2(direction.y, direction.x);
  const double radius_m = std::max(fill, 0.0) * (section.radius_m + thickness_m);
  return section.centre + radius_m * std::cos(azimuth_rad) * section.u +
         radius_m * std::sin(azimuth_rad) * section.v;
}

// The first of the nearest. Distances that round to the same value count as equal. Only stretches
// that may be as near as the nearest hub are examined.
const Tube::Section* Tube::nearest(Vec3d point, double far_m) const {
  constexpr std::size_t kFours = (kSections + 4) / 4, kHubs = (kSections + kStretch) / kStretch;
  constexpr double kSlack = 1 + 1e-9;  // for rounding
  std::array<Doubles4, (kHubs + 3) / 4> hubs;
  Doubles4 least{kFar, kFar, kFar, kFar};
  for (std::size_t k = 0; k < hubs.size(); ++k) {
    hubs[k] = hubs_[k].squares(point);
    least = smaller(hubs[k], least);
  }
  const double hub_m = std::sqrt(std::min({least[0], least[1], least[2], least[3]}));
  if (hub_m > kSlack * (far_m + hub_reach_m_)) return nullptr;
  const double reach_m = kSlack * (hub_m + hub_reach_m_), within = reach_m * reach_m;
  std::array<Doubles4, kFours> squares;
  least = Doubles4{kFar, kFar, kFar, kFar};
  for (std::size_t h = 0; h < kHubs; ++h) {
    if (hubs[h / 4][h % 4] > within) continue;
    for (std::size_t k = h * kStretch / 4; k < std::min((h + 1) * kStretch / 4, kFours); ++k) {
      squares[k] = fours_[k].squares(point);
      least = smaller(squares[k], least);
    }
  }
  const double best = std::min({least[0], least[1], least[2], least[3]}), best_m = std::sqrt(best);
  for (std::size_t h = 0; h < kHubs; ++h) {
    if (hubs[h / 4][h % 4] > within) continue;
    for (std::size_t i = h * kStretch; i < std::min((h + 1) * kStretch, sections_.size()); ++i) {
      const double square = squares[i / 4][i % 4];
      if (square <= best * (1 + 1e-15) && std::sqrt(square) == best_m) return &sections_[i];
    }
  }
  return &sections_.back();
}

void Tube::pushOut(double gap_m, std::vector<Vec3d>& points) const {
  constexpr double kRounding_m = 4e-3;
  const double far_m = most_radius_m_ + gap_m + 10 * kRounding_m;
  const Vec3d margin{far_m, far_m, far_m};
  const Box within{centres_m_.lo - margin, centres_m_.hi + margin};
  for (std::size_t i = 0; i < points.size(); i += kDoubleLanes) {
    const FourPoints p = fourPointsAt(points, i);
    FourPoints centre{};
    Doubles4 radius_m{};
    Mask4 near{};
    for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
      const Vec3d point{p.x[lane], p.y[lane], p.z[lane]};
      if (!within.contains(point)) continue;
      const Section* const section = nearest(point, far_m);
      if (section == nullptr) continue;
      centre.x[lane] = section->centre.x, centre.y[lane] = section->centre.y;
      centre.z[lane] = section->centre.z, radius_m[lane] = section->radius_m;
      near[lane] = -1;
    }
    const FourPoints away = p - centre;
    const Doubles4 distance_m = squareRoot(dot(away, away)), limit_m = radius_m + gap_m;
    const FourPoints moved =
        centre + (smoothMax(distance_m, limit_m, kRounding_m) / distance_m) * away;
    near = near & (distance_m <= limit_m + 10 * kRounding_m) & (distance_m >= 1e-6);
    put(where(near, moved, p), points, i);
  }
}

}  // namespace echocine::heart
