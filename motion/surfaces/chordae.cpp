#include "motion/surfaces/chordae.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/surfaces/leaflet_share.h"
#include "scene/role.h"

namespace echocine {

namespace {

// About twenty strands leave the papillary muscles: 10.4 and 9.7 on average (Kavitha et al., Int J
// Curr Res Rev 6(3), 1-6, 2014). They insert at the free edge and into the rough zone (Lam et al.,
// Circulation 41, 449-458, 1970).
constexpr std::size_t kPerLeaflet = 10;
constexpr float kFree = 0.6f;         // of the largest displacement: free edge and rough zone
constexpr double kLongest_m = 80e-3;  // longer ones would belong to another heart's muscle
constexpr double kMostSag = 0.15;     // of the distance of the ends. Our choice

// The freest vertex, then always the candidate farthest from those chosen.
std::vector<std::uint32_t> spreadOver(const std::vector<float>& share,
                                      const std::vector<Vec3f>& at_m) {
  std::vector<std::uint32_t> candidates, chosen;
  for (std::uint32_t v = 0; v < share.size(); ++v)
    if (share[v] >= kFree) candidates.push_back(v);
  if (candidates.empty()) return chosen;
  std::vector<float> gap_m(candidates.size(), std::numeric_limits<float>::infinity());
  std::uint32_t next =
      *std::max_element(candidates.begin(), candidates.end(),
                        [&](std::uint32_t a, std::uint32_t b) { return share[a] < share[b]; });
  for (;;) {
    chosen.push_back(next);
    if (chosen.size() == std::min(kPerLeaflet, candidates.size())) return chosen;
    for (std::size_t i = 0; i < candidates.size(); ++i)
      gap_m[i] = std::min(gap_m[i], length(at_m[candidates[i]] - at_m[next]));
    const auto farthest = std::max_element(gap_m.begin(), gap_m.end()) - gap_m.begin();
    next = candidates[static_cast<std::size_t>(farthest)];
  }
}

// 1 at the vertex nearest to a papillary muscle, 0 at the farthest; all 0 without muscles.
std::vector<float> nearnessToMuscles(const Scene& scene, const SurfaceFrame& frame,
                                     const std::vector<Vec3f>& at_m) {
  std::vector<float> gap_m;
  for (const Vec3f p : at_m) {
    float least_m = std::numeric_limits<float>::infinity();
    for (std::size_t s = 0; s < scene.structures.size(); ++s)
      if (roleOf(scene.structures[s]) == Role::papillary_muscle)
        for (const Vec3f q : frame.positions_m[s]) least_m = std::min(least_m, length(p - q));
    gap_m.push_back(least_m);
  }
  if (gap_m.empty()) return gap_m;
  const auto [least, most] = std::minmax_element(gap_m.begin(), gap_m.end());
  const float low_m = *least, range_m = *most - *least;
  for (float& g : gap_m) g = range_m > 0 && std::isfinite(low_m) ? 1 - (g - low_m) / range_m : 0;
  return gap_m;
}

double distance(const SurfaceFrame& frame, const Chordae::Chord& chord) {
  return length(toDouble(frame.positions_m[index(chord.muscle)][chord.origin] -
                         frame.positions_m[index(chord.leaflet)][chord.insertion]));
}

Vec3d insertionOf(const SurfaceFrame& frame, const Chordae::Chord& chord) {
  return toDouble(frame.positions_m[index(chord.leaflet)][chord.insertion]);
}

struct Insertions {
  Vec3d middle{};
  double rms_m = 0;
};

Insertions spreadOf(const SurfaceFrame& frame, const std::vector<Chordae::Chord>& chords) {
  const double each = 1.0 / static_cast<double>(chords.size());
  Insertions spread;
  for (const Chordae::Chord& chord : chords)
    spread.middle = spread.middle + each * insertionOf(frame, chord);
  for (const Chordae::Chord& chord : chords)
    spread.rms_m += each * std::pow(length(insertionOf(frame, chord) - spread.middle), 2);
  spread.rms_m = std::sqrt(spread.rms_m);
  return spread;
}

}  // namespace

Chordae::Chordae(const Scene& scene, const MeshMotion& motion) {
  std::vector<SurfaceId> ends;
  for (const SurfaceTopology& surface : motion.surfaces()) {
    const Role role = roleOf(scene.structures[index(surface.id)]);
    if (role == Role::mitral_valve || role == Role::papillary_muscle) ends.push_back(surface.id);
  }
  const std::vector<SurfaceFrame> frames = instantsOfBeat(motion, ends);
  for (const SurfaceTopology& leaflet : motion.surfaces()) {
    const std::size_t s = index(leaflet.id);
    if (roleOf(scene.structures[s]) != Role::mitral_valve) continue;
    const std::vector<Vec3f>& at_m = frames.front().positions_m[s];
    std::vector<float> share = shareOfMotion(frames, s);
    if (std::all_of(share.begin(), share.end(), [](float x) { return x == 0; }))
      share = nearnessToMuscles(scene, frames.front(), at_m);
    attach(scene, frames, leaflet.id, spreadOver(share, at_m));
  }
  if (chords_.empty()) return;
  closed_m_ = std::numeric_limits<double>::infinity();
  for (const SurfaceFrame& frame : frames) {
    const double rms_m = spreadOf(frame, chords_).rms_m;
    closed_m_ = std::min(closed_m_, rms_m);
    open_m_ = std::max(open_m_, rms_m);
  }
}

// The origin has the least mean square of its distance over the beat.
void Chordae::attach(const Scene& scene, const std::vector<SurfaceFrame>& frames, SurfaceId leaflet,
                     const std::vector<std::uint32_t>& insertions) {
  for (const std::uint32_t insertion : insertions) {
    Chord best{.leaflet = leaflet, .insertion = insertion};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < scene.structures.size(); ++s) {
      if (roleOf(scene.structures[s]) != Role::papillary_muscle) continue;
      const auto count = static_cast<std::uint32_t>(frames.front().positions_m[s].size());
      for (std::uint32_t v = 0; v < count; ++v) {
        const Chord chord{static_cast<SurfaceId>(s), leaflet, v, insertion};
        double squares = 0;
        for (const SurfaceFrame& frame : frames) squares += std::pow(distance(frame, chord), 2);
        if (squares >= least) continue;
        least = squares;
        best = chord;
      }
    }
    if (std::isinf(least)) return;  // no muscle
    for (const SurfaceFrame& frame : frames)
      best.length_m = std::max(best.length_m, distance(frame, best));
    if (best.length_m > 0 && best.length_m <= kLongest_m) chords_.push_back(best);
  }
}

void Chordae::at(const SurfaceFrame& frame, std::vector<Vec3f>& points_m) const {
  points_m.clear();
  if (chords_.empty() || frame.positions_m.empty()) return;
  const auto [middle, rms_m] = spreadOf(frame, chords_);
  const double opening =
      open_m_ > closed_m_ ? std::clamp((rms_m - closed_m_) / (open_m_ - closed_m_), 0.0, 1.0) : 0;
  for (const Chord& chord : chords_) {
    const Vec3d from = toDouble(frame.positions_m[index(chord.muscle)][chord.origin]);
    const Vec3d to = insertionOf(frame, chord);
    const double apart_m = length(to - from);
    const Vec3d along = apart_m > 0 ? (1 / apart_m) * (to - from) : Vec3d{};
    const Vec3d out = (to - middle) - dot(to - middle, along) * along;
    const double out_m = length(out);
    // A flat parabola of height h has the length d (1 + 8/3 (h/d)^2).
    const double slack = apart_m > 0 ? std::max(chord.length_m / apart_m - 1, 0.0) : 0;
    const double sag_m = opening * apart_m * std::min(std::sqrt(0.375 * slack), kMostSag);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double t = static_cast<double>(i) / (kPoints - 1);
      Vec3d p = from + t * (to - from);
      if (out_m > 0) p = p + (4 * t * (1 - t) * sag_m / out_m) * out;
      points_m.push_back(toFloat(p));
    }
  }
}

}  // namespace echocine
