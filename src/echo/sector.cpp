#include "echo/sector.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/error.h"
#include "core/units.h"
#include "echo/echo_pixels.h"
#include "echo/sector_edges.h"

namespace echocine::echo {

namespace {

// Share of live pixels along the arc of each whole radius between the edges.
std::vector<double> liveByRadius(const EchoPixels& area, const Sector& s) {
  const int largest = static_cast<int>(std::hypot(area.width, area.height + std::abs(s.apex_y)));
  std::vector<double> share;
  for (int r = 0; r < largest; ++r) {
    // A step per pixel of the arc.
    const int steps = std::max(9, static_cast<int>(r * (s.last_rad - s.first_rad)));
    int live = 0, seen = 0;
    for (int i = 0; i <= steps; ++i) {
      const double angle = s.first_rad + (s.last_rad - s.first_rad) * i / steps;
      const double x = s.apex_x + (r + 0.5) * std::sin(angle),
                   y = s.apex_y + (r + 0.5) * std::cos(angle);
      if (x < 0 || y < 0 || x >= area.width || y >= area.height) continue;
      ++seen;
      live += area.at(static_cast<int>(x), static_cast<int>(y)) ? 1 : 0;
    }
    share.push_back(seen > 4 ? static_cast<double>(live) / seen : 0);
  }
  return share;
}

// The lower end: the steepest fall of the live share among those that leave nothing below.
void findRadii(const EchoPixels& area, Sector& s) {
  const std::vector<double> share = liveByRadius(area, s);
  double most = 0;
  for (const double v : share) most = std::max(most, v);
  // Below the sector a few pixels may live by chance: a tenth of the arc, or less where the loop is
  // dark.
  const double floor_share = std::min(0.1, 0.25 * most);
  std::size_t last = share.size();
  while (last > 0 && share[last - 1] < floor_share) --last;
  s.r_max = static_cast<double>(last);
  std::size_t first = 0;
  while (first + 1 < last && share[first] < 0.5 * most) ++first;
  s.r_min = static_cast<double>(first);
}

// The lowest live pixel of each angle, as far as it lies near the lower arc.
std::vector<EdgePoint> lowerArc(const EchoPixels& area, const Sector& s) {
  std::vector<EdgePoint> points;
  constexpr int kAngles = 400;
  for (int i = 1; i < kAngles; ++i) {
    const double angle = s.first_rad + (s.last_rad - s.first_rad) * i / kAngles;
    // The arc is looked for 30 % about the radius that was found: as far as pixels may be
    // stretched.
    for (double r = 1.3 * s.r_max; r > 0.7 * s.r_max; r -= 0.5) {
      const double x = s.apex_x + r * std::sin(angle), y = s.apex_y + r * std::cos(angle);
      if (!area.at(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)))) continue;
      // An arc cut off by the picture's foot is no arc.
      if (y < area.height - 1.5) points.push_back({x, y});
      break;
    }
  }
  return points;
}

// With pixels q times as high as wide the arc obeys X + q^2 Y = R^2 for the squares X and Y of the
// distances from the apex: least squares for R^2 and q^2, twice without outliers. 1 if the arc is
// too short.
double aspectOfArc(const std::vector<EdgePoint>& arc, const Sector& s) {
  std::vector<EdgePoint> points = arc;
  double q2 = 1;
  for (int round = 0; round < 3; ++round) {
    double n = 0, sy = 0, sx = 0, syy = 0, sxy = 0, widest = 0, narrowest = 1e9;
    for (const EdgePoint p : points) {
      const double x2 = (p.x - s.apex_x) * (p.x - s.apex_x),
                   y2 = (p.y - s.apex_y) * (p.y - s.apex_y);
      ++n, sx += x2, sy += y2, syy += y2 * y2, sxy += x2 * y2;
      widest = std::max(widest, x2 / (s.r_max * s.r_max));
      narrowest = std::min(narrowest, x2 / (s.r_max * s.r_max));
    }
    const double d = n * syy - sy * sy;
    // Our choices: too few points, or an arc so short that X and Y are not separable.
    if (n < 40 || widest - narrowest < 0.1 || d <= 0) return 1;
    q2 = -(n * sxy - sx * sy) / d;
    const double r2 = (sx + q2 * sy) / n;
    if (!(q2 > 0.05 && r2 > 0)) return 1;
    std::vector<EdgePoint> kept;
    for (const EdgePoint p : points) {
      const double r =
          std::sqrt((p.x - s.apex_x) * (p.x - s.apex_x) + q2 * (p.y - s.apex_y) * (p.y - s.apex_y));
      if (std::abs(r - std::sqrt(r2)) < (round == 0 ? 0.02 : 0.008) * s.r_max) kept.push_back(p);
    }
    if (kept.size() < points.size() / 2) return 1;  // dark below: no arc to be seen
    points = kept;
  }
  return std::sqrt(q2);
}

// The sector of one threshold; the reason why not when there is none.
struct Attempt {
  SectorFind found;
  std::string failure;
};

Attempt attempt(const Video& video, int moving) {
  const EchoPixels area = echoPixels(video, moving);
  const auto lit = std::count_if(area.live.begin(), area.live.end(), [](auto v) { return v != 0; });
  // Two per cent of the picture: less is a still, or a dark loop.
  if (static_cast<double>(lit) < 0.02 * static_cast<double>(area.live.size()))
    return {{}, "too few pixels move or are bright"};
  const std::vector<EdgePoint> left = outermost(area, -1), right = outermost(area, 1);
  // Two pixels at a thousand across: what scan conversion and codecs smear.
  const double tolerance = std::max(1.0, 0.002 * video.width);
  const auto left_line = edgeLine(left, -1, tolerance), right_line = edgeLine(right, 1, tolerance);
  if (!left_line || !right_line) return {{}, "the moving area has no two straight edges"};
  SectorFind found;
  Sector& s = found.sector;
  // Where both edges meet: the apex, which for a curvilinear probe lies above the picture.
  s.apex_y = (right_line->at_zero - left_line->at_zero) / (left_line->slope - right_line->slope);
  s.apex_x = left_line->at_zero + left_line->slope * s.apex_y;
  s.first_rad = std::atan(left_line->slope);
  s.last_rad = std::atan(right_line->slope);
  findRadii(area, s);
  // Our choices: a fifth of the picture, 15 degrees.
  if (s.r_max < 0.2 * video.height || s.last_rad - s.first_rad < radiansFromDegrees(15))
    return {{}, "the lines through its edges enclose no sector"};
  // Rows that the edges can span: from the near end to where the lower arc begins.
  const auto rows = [&](double angle, const EdgeLine& line) {
    const double top = std::max(0.0, s.apex_y + s.r_min * std::cos(angle));
    const double foot = std::min<double>(video.height, s.apex_y + s.r_max * std::cos(angle));
    return std::min(1.0, line.inliers / std::max(1.0, foot - top));
  };
  found.edge_inliers = 0.5 * (rows(s.first_rad, *left_line) + rows(s.last_rad, *right_line));
  double inside = 0, all = 0;
  for (int y = 0; y < video.height; ++y)
    for (int x = 0; x < video.width; ++x)
      if (area.at(x, y)) ++all, inside += s.contains(x + 0.5, y + 0.5) ? 1 : 0;
  // Motion elsewhere (an ECG, a second sector) may have a share of 15 %.
  if (inside < 0.85 * all)
    return {{},
            fmt::format("{:.0f} % of the moving area lies outside the best fit",
                        100 * (1 - inside / all))};
  found.aspect = aspectOfArc(lowerArc(area, s), s);
  return {found, {}};
}

}  // namespace

bool Sector::contains(double x, double y) const {
  const double dx = x - apex_x, dy = y - apex_y;
  const double r = std::hypot(dx, dy), angle = std::atan2(dx, dy);
  return r >= r_min && r <= r_max && angle >= first_rad && angle <= last_rad;
}

SectorFind findSector(const Video& video) {
  // From faint to strong: dim edges need a low threshold, noisy codecs a high one. The one whose
  // edges are seen along most of their length wins.
  std::optional<SectorFind> best;
  std::string failure;
  for (const int moving : {1, 2, 3, 5, 8, 13}) {
    const Attempt a = attempt(video, moving);
    if (a.failure.empty() && (!best || a.found.edge_inliers > best->edge_inliers)) best = a.found;
    if (!a.failure.empty()) failure = a.failure;
  }
  if (!best || best->edge_inliers < 0.2)
    throw SceneError(
        fmt::format("{}: no sector found ({}); give it as "
                    "apex_x,apex_y,first_deg,last_deg,r_min,r_max",
                    video.name, best ? "its edges are hardly visible" : failure));
  return *best;
}

Sector parseSector(const std::string& option, const std::string& text) {
  std::vector<double> values;
  const char *at = text.data(), *end = at + text.size();
  for (;; ++at) {
    double value = 0;
    const auto result = std::from_chars(at, end, value);
    if (result.ec != std::errc() || !std::isfinite(value)) break;
    values.push_back(value);
    at = result.ptr;
    if (at == end || *at != ',') break;
  }
  // Six numbers and nothing behind them; edges within 90 degrees of straight down, in their order.
  const auto sound = [&] {
    return at == end && values.size() == 6 && values[2] < values[3] && values[2] > -90 &&
           values[3] < 90 && values[4] >= 0 && values[4] < values[5] && values[5] < 1e5 &&
           std::abs(values[0]) < 1e5 && std::abs(values[1]) < 1e5;
  };
  if (!sound())
    throw SceneError(
        fmt::format("{}: \"{}\" is not a sector, accepted: "
                    "apex_x,apex_y,first_deg,last_deg,r_min,r_max in pixels "
                    "and degrees from straight down, such as 170,6,-42,41.6,4,197",
                    option, text));
  return {values[0], values[1], radiansFromDegrees(values[2]), radiansFromDegrees(values[3]),
          values[4], values[5]};
}

PixelPlane overlayMask(const Video& video, const Sector& sector) {
  const EchoPixels area = echoPixels(video, 6);
  PixelPlane mask = video.coloured;
  double coloured = 0, inside = 0;
  for (int y = 0; y < video.height; ++y)
    for (int x = 0; x < video.width; ++x) {
      const auto p = static_cast<std::size_t>(y) * static_cast<std::size_t>(video.width) +
                     static_cast<std::size_t>(x);
      if (!sector.contains(x + 0.5, y + 0.5)) continue;
      ++inside;
      coloured += video.coloured[p];
      // Text and marks are bright and do not move; echoes flicker.
      if (area.highest[p] > 120 && area.range[p] <= 2) mask[p] = 1;
    }
  constexpr double kMostColoured = 0.6;
  if (coloured > kMostColoured * inside)
    throw SceneError(
        fmt::format("{}: colour covers {:.0f} % of its sector (a colour Doppler box?), too little "
                    "is left to compare; give a grey-scale loop of the same view",
                    video.name, 100 * coloured / inside));
  return mask;
}

}  // namespace echocine::echo
