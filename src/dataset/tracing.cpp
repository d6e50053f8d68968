#include "dataset/tracing.h"

#include <algorithm>

#include "truth/simpson.h"

namespace echocine::dataset {

namespace {

double perimeter(std::span<const Vec3d> points) {
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    sum += length(points[(i + 1) % points.size()] - points[i]);
  return sum;
}

// Where the line through `at` along `across` first enters and last leaves the outline, as distances
// from `at`. Nothing where it passes by.
std::optional<std::pair<double, double>> crossed(std::span<const Vec3d> outline, Vec3d at,
                                                 Vec3d along, Vec3d across) {
  std::optional<std::pair<double, double>> ends;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec3d a = outline[i] - at, b = outline[(i + 1) % outline.size()] - at;
    const double da = dot(a, along), db = dot(b, along);
    if ((da < 0) == (db < 0)) continue;
    const double offset = dot(a, across) + (dot(b, across) - dot(a, across)) * da / (da - db);
    if (!ends) ends.emplace(offset, offset);
    ends = std::pair(std::min(ends->first, offset), std::max(ends->second, offset));
  }
  return ends;
}

}  // namespace

std::span<const Vec3d> longestContour(std::span<const Contour> contours, SurfaceId surface) {
  std::span<const Vec3d> longest;
  double most_m = 0;
  for (const Contour& contour : contours) {
    if (contour.surface != surface || !contour.closed) continue;
    const double length_m = perimeter(contour.points_m);
    if (length_m <= most_m) continue;
    most_m = length_m;
    longest = contour.points_m;
  }
  return longest;
}

std::optional<PlaneTracing> traceCavity(std::span<const Vec3d> outline, Vec3d mitral) {
  if (outline.size() < 3) return std::nullopt;
  PlaneTracing tracing;
  const Vec3d ring{mitral.x, 0, mitral.z};
  const auto farther = [&](Vec3d a, Vec3d b) { return length(a - ring) < length(b - ring); };
  tracing.apex = *std::max_element(outline.begin(), outline.end(), farther);
  const Vec3d along = normalised(ring - tracing.apex), across = cross(along, Vec3d{0, 1, 0});
  const auto along_axis = crossed(outline, tracing.apex, across, along);
  if (!along_axis) return std::nullopt;
  tracing.length_m = along_axis->second;
  const Vec3d span = tracing.length_m * along;
  tracing.base = tracing.apex + span;
  for (int i = 0; i < kDiscs; ++i) {
    const auto ends = crossed(outline, tracing.apex + ((i + 0.5) / kDiscs) * span, along, across);
    if (!ends) return std::nullopt;
    tracing.disc_widths_m.push_back(ends->second - ends->first);
  }
  // The ends themselves only touch the outline; an oblique mitral plane is met a little before its
  // middle.
  constexpr double kInside = 0.985;
  tracing.chords.emplace_back(tracing.apex, tracing.apex);
  for (int i = 1; i < kChords; ++i) {
    const double share = std::min(kInside, 1.0 * i / (kChords - 1));
    const auto ends = crossed(outline, tracing.apex + share * span, along, across);
    if (!ends) return std::nullopt;
    const Vec3d at = tracing.apex + (1.0 * i / (kChords - 1)) * span;
    tracing.chords.emplace_back(at + ends->first * across, at + ends->second * across);
  }
  return tracing;
}

}  // namespace echocine::dataset
