#include "speckle/sheet_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/hash_random.h"

namespace echocine {

namespace {

constexpr double kApartPerWidth = 0.5, kOrdinaryPerCell = 3;
constexpr double kChordPerSheet = 4;  // a line in a cell needs more than a sheet. Our choice
constexpr double kMostPoints = 1e7;   // 0.2 GB. Our choice
constexpr int kSheetPhases = 32;
constexpr double kBetweenPhases_m = 2e-3;

// Purposes of hashed numbers.
enum : std::uint64_t {
  kSheetCount = 11,
  kSheetPlace = 12,
  kSheetThrough = 17,
  kChordPlace = 18,
  kRingCount = 19,
  kRingPlace = 20
};

double areaOf(const Triangle& t, const std::vector<Vec3f>& at) {
  return 0.5 * static_cast<double>(length(cross(at[t[1]] - at[t[0]], at[t[2]] - at[t[0]])));
}

// Fewer scatterers follow from a lower value of the key.
void refuseTooManyOnStrands(double planned, const std::string& key, const Scene& scene) {
  if (planned <= kMostPoints) return;
  throw SceneError(fmt::format(
      "{} needs over {:g} scatterers at {:g} MHz and {:g} cycles, the memory limit: use a lower "
      "value, a lower probe.frequency_mhz or longer pulses",
      key, kMostPoints, 1e-6 * scene.probe.frequency_hz, scene.signal.pulse_cycles));
}

}  // namespace

SheetPoints::SheetPoints(const Scene& scene, const MeshMotion& motion, double reference_phase,
                         ValveParts valves)
    : motion_(motion), valves_(std::move(valves)) {
  const auto& surfaces = motion.surfaces();
  std::vector<SurfaceId> sheets;
  for (const SurfaceTopology& surface : surfaces)
    if (surface.membrane) sheets.push_back(surface.id);
  if (sheets.empty() && !valves_.chordae && !valves_.rings) return;
  const PointSpread spread(scene);
  const double apart_m = kApartPerWidth * spread.axial_width_m;
  if (valves_.chordae) drawOnChords(scene, apart_m / kChordPerSheet);
  if (valves_.rings) drawOnRings(scene, 1 / (apart_m * apart_m * apart_m));
  if (sheets.empty()) return;
  const double per_m2 = scene.speckle.per_cell / kOrdinaryPerCell / (apart_m * apart_m);
  SurfaceFrame frame;
  motion.positionsAt(reference_phase, sheets, frame);
  for (const SurfaceId sheet : sheets)
    draw(surfaces[index(sheet)], frame.positions_m[index(sheet)], per_m2, scene.speckle);
  const double widest_m = std::max(spread.elevationWidth(scene.probe.min_depth_m),
                                   spread.elevationWidth(scene.probe.max_depth_m));
  dropUnseen(sheets, kElevationCut * widest_m + kBetweenPhases_m);
}

void SheetPoints::draw(const SurfaceTopology& sheet, const std::vector<Vec3f>& positions_m,
                       double per_m2, const SpeckleSettings& settings) {
  double planned = static_cast<double>(points_.size());
  for (const Triangle& t : sheet.triangles) planned += per_m2 * areaOf(t, positions_m);
  if (!(planned <= kMostPoints))
    throw SceneError(fmt::format(
        "speckle.per_cell = {:g} needs over {:g} scatterers on membranes, the memory limit: use a "
        "lower value",
        settings.per_cell, kMostPoints));
  const int seed = settings.seed;
  const std::uint64_t surface = index(sheet.id);
  for (std::uint32_t t = 0; t < sheet.triangles.size(); ++t) {
    const double wanted = per_m2 * areaOf(sheet.triangles[t], positions_m);
    const auto count =
        static_cast<std::uint32_t>(wanted + uniformFromHash(hashOf(seed, kSheetCount, surface, t)));
    for (std::uint32_t j = 0; j < count; ++j) {
      const auto drawn = [&](int axis) {
        return static_cast<float>(uniformFromHash(hashOf(seed, kSheetPlace, surface, t, j, axis)));
      };
      float b1 = drawn(0), b2 = drawn(1);
      if (b1 + b2 > 1) {  // the square's other half, folded back
        b1 = 1 - b1;
        b2 = 1 - b2;
      }
      points_.push_back({.surface = sheet.id, .triangle = t, .b1 = b1, .b2 = b2});
      through_.push_back(
          static_cast<float>(2 * uniformFromHash(hashOf(seed, kSheetThrough, surface, t, j)) - 1));
    }
  }
}

// Evenly spaced along each chord at rest, uniform over its section's circumscribed ball.
void SheetPoints::drawOnChords(const Scene& scene, double apart_m) {
  const std::vector<Chordae::Chord>& chords = valves_.chordae->chords();
  double planned = 0;
  for (const Chordae::Chord& chord : chords) planned += chord.length_m / apart_m;
  refuseTooManyOnStrands(planned, "leaflets.chordae_mm", scene);
  const auto radius_m = static_cast<float>(0.5 * scene.leaflets.chordae_m);
  for (std::uint32_t c = 0; c < chords.size(); ++c) {
    const auto count = static_cast<std::uint32_t>(std::ceil(chords[c].length_m / apart_m));
    for (std::uint32_t j = 0; j < count; ++j) {
      const auto drawn = [&](int axis) {
        return static_cast<float>(
            uniformFromHash(hashOf(scene.speckle.seed, kChordPlace, c, j, axis)));
      };
      const float z = 2 * drawn(0) - 1, turn_rad = 2 * std::numbers::pi_v<float> * drawn(1),
                  out_m = radius_m * std::cbrt(drawn(2)), across = std::sqrt(1 - z * z);
      on_chords_.push_back(
          {c, (static_cast<float>(j) + 0.5f) / static_cast<float>(count),
           out_m * Vec3f{across * std::cos(turn_rad), across * std::sin(turn_rad), z}});
    }
  }
}

// Uniform over each stretch of a ring.
void SheetPoints::drawOnRings(const Scene& scene, double per_m3) {
  const double per_m =
      per_m3 * std::numbers::pi * valves_.rings->radius() * valves_.rings->radius();
  const std::vector<ValveRings::Stretch>& stretches = valves_.rings->stretches();
  double planned = 0;
  for (const ValveRings::Stretch& stretch : stretches) planned += per_m * stretch.length_m;
  refuseTooManyOnStrands(
      planned, fmt::format("leaflets.annulus_mm = {:g}", 1e3 * scene.leaflets.annulus_m), scene);
  for (std::uint32_t s = 0; s < stretches.size(); ++s) {
    const auto count = static_cast<std::uint32_t>(
        per_m * stretches[s].length_m + uniformFromHash(hashOf(scene.speckle.seed, kRingCount, s)));
    for (std::uint32_t j = 0; j < count; ++j) {
      const auto drawn = [&](int axis) {
        return static_cast<float>(
            uniformFromHash(hashOf(scene.speckle.seed, kRingPlace, s, j, axis)));
      };
      const float out = std::sqrt(drawn(1)), turn_rad = 2 * std::numbers::pi_v<float> * drawn(2);
      on_rings_.push_back({s, drawn(0), out * std::cos(turn_rad), out * std::sin(turn_rad)});
    }
  }
}

void SheetPoints::dropUnseen(std::span<const SurfaceId> sheets, double reach_m) {
  std::vector<bool> seen(points_.size());
  std::vector<Vec3f> places_m;
  SurfaceFrame frame;
  for (int i = 0; i < kSheetPhases; ++i) {
    motion_.positionsAt(static_cast<double>(i) / kSheetPhases, sheets, frame);
    onSheetsAt(frame, places_m);
    for (std::size_t p = 0; p < seen.size(); ++p)
      seen[p] = seen[p] || std::abs(static_cast<double>(places_m[p].y)) < reach_m;
  }
  std::size_t kept = 0;
  for (std::size_t p = 0; p < seen.size(); ++p)
    if (seen[p]) {
      through_[kept] = through_[p];
      points_[kept++] = points_[p];
    }
  points_.resize(kept);
  through_.resize(kept);
}

void SheetPoints::onSheetsAt(const SurfaceFrame& surfaces, std::vector<Vec3f>& places_m) const {
  places_m.clear();
  thread_local std::vector<std::vector<Vec3f>> front_m;
  front_m.resize(surfaces.positions_m.size());
  for (const SurfaceTopology& sheet : motion_.surfaces())
    if (valves_.leaflets && valves_.leaflets->isBody(sheet.id))
      valves_.leaflets->toFront(sheet.id, surfaces.positions_m[index(sheet.id)],
                                front_m[index(sheet.id)]);
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const std::size_t s = index(points_[p].surface);
    const std::vector<Triangle>& faces = motion_.surfaces()[s].triangles;
    const Vec3f on_sheet_m = place(points_[p], faces, surfaces.positions_m[s]);
    const bool thick = valves_.leaflets && valves_.leaflets->isBody(points_[p].surface);
    places_m.push_back(thick ? on_sheet_m + through_[p] * place(points_[p], faces, front_m[s])
                             : on_sheet_m);
  }
}

void SheetPoints::at(const SurfaceFrame& surfaces, std::vector<Vec3f>& places_m) const {
  places_m.clear();
  if (surfaces.positions_m.empty()) return;
  onSheetsAt(surfaces, places_m);
  thread_local std::vector<Vec3f> chords_m;
  if (!on_chords_.empty()) valves_.chordae->at(surfaces, chords_m);
  for (const OnChord& point : on_chords_) {
    const float walked = point.along * (Chordae::kPoints - 1);
    const auto i = static_cast<std::size_t>(walked);
    const Vec3f* const from = &chords_m[point.chord * Chordae::kPoints + i];
    const float t = walked - static_cast<float>(i);
    places_m.push_back(from[0] + t * (from[1] - from[0]) + point.beside_m);
  }
  thread_local std::vector<ValveRings::Section> sections;
  if (!on_rings_.empty()) valves_.rings->at(surfaces, sections);
  for (const OnRing& point : on_rings_) {
    const ValveRings::Stretch& stretch = valves_.rings->stretches()[point.stretch];
    const Vec3f from_m = valves_.rings->place(sections[stretch.from], point.a, point.b),
                to_m = valves_.rings->place(sections[stretch.to], point.a, point.b);
    places_m.push_back(from_m + point.along * (to_m - from_m));
  }
}

}  // namespace echocine
