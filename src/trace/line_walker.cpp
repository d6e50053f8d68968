#include "trace/line_walker.h"

#include <algorithm>
#include <limits>

namespace echocine {

namespace {

// A ray that bends more often is caught in a wedge; what it could still send back is nothing.
constexpr int kMaxBends = 1000;

}  // namespace

LineWalker::LineWalker(const TraceSettings& settings, const Ray& start, const InsideSet& inside,
                       LineTrace& trace, double start_m)
    : settings_(settings),
      trace_(trace),
      query_{start, inside, {}},
      ruling_(settings),
      at_{.walked_m = start_m, .wave = start.direction},
      layer_(settings.frequency_hz, settings.pulse_cycles) {
  trace_.clear();
}

// Eq. 3 along one medium, there and back: A grows by 4 alpha per metre.
void LineWalker::walkTo(double distance_m) {
  const Medium& medium = settings_.media[index(at_.medium)];
  const double path_per_depth =
      settings_.travel_time ? medium.sound_speed_m_s / kScannerSpeed : 1.0;
  const double exponent_per_path = settings_.attenuation ? 4 * medium.attenuation_np_per_m : 0.0;
  double step_m = distance_m - at_.walked_m;
  const double end_depth_m =
      at_.depth_m + (settings_.travel_time ? step_m / path_per_depth : step_m);
  if (end_depth_m >= settings_.max_depth_m) {
    step_m = (settings_.max_depth_m - at_.depth_m) * path_per_depth;
    at_.alive = false;
  }
  const double next_depth_m = at_.alive ? end_depth_m : settings_.max_depth_m;
  const double eta_b = settings_.backscatter ? medium.backscatter_per_m_sr : 0.0;
  trace_.segments.push_back({.begin_depth_m = at_.depth_m,
                             .end_depth_m = next_depth_m,
                             .begin_path_m = at_.path_m,
                             .path_per_depth = path_per_depth,
                             .begin_exponent = at_.exponent,
                             .exponent_per_m = exponent_per_path * path_per_depth,
                             .strength_m2_sr = eta_b * settings_.unit_volume_m3 * at_.passed,
                             .medium = at_.medium,
                             .structure = ruling_.structure()});
  at_.walked_m += step_m;
  at_.path_m += step_m;
  at_.depth_m = next_depth_m;
  at_.exponent += exponent_per_path * step_m;
  if (settings_.note_hits) trace_.end_m = query_.ray.origin + at_.walked_m * query_.ray.direction;
}

// The crossing whose normal and lobe represent a group of coincident surfaces.
const Crossing& LineWalker::deciding(Group group) const {
  if (group.size() == 1) return group.front();
  return *std::max_element(
      group.begin(), group.end(), [this](const Crossing& a, const Crossing& b) {
        const SurfaceTraits& s = settings_.surfaces[index(a.surface)];
        const SurfaceTraits& t = settings_.surfaces[index(b.surface)];
        if (s.membrane != t.membrane) return s.membrane;
        return std::pair(s.priority, a.surface) < std::pair(t.priority, b.surface);
      });
}

// For integration over cells: every crossing with the media and losses of this line. If surfaces
// coincide, only the deciding one is visible.
void LineWalker::noteHits(Group group, MediumId after) {
  const Medium& medium = settings_.media[index(at_.medium)];
  const Crossing& decided = deciding(group);
  const Vec3d along = query_.ray.direction, across = echocine::cross(Vec3d{0, 1, 0}, along);
  const Vec3d incident = incidentAt(decided);
  for (const Crossing& c : group) {
    const SurfaceTraits& surface = settings_.surfaces[index(c.surface)];
    const bool seen = surface.membrane || (after != at_.medium && &c == &decided);
    trace_.hits.push_back(
        {.surface = c.surface,
         .entering = c.entering,
         .seen = seen,
         .before = at_.medium,
         .after = surface.membrane ? surface.medium : after,
         .point = query_.ray.origin + at_.walked_m * along,
         .path_m = at_.path_m,
         .depth_m = at_.depth_m,
         .path_per_depth = settings_.travel_time ? medium.sound_speed_m_s / kScannerSpeed : 1.0,
         .exponent = at_.exponent,
         .exponent_per_path = settings_.attenuation ? 4 * medium.attenuation_np_per_m : 0.0,
         .passed = at_.passed});
    if (settings_.snell_angles && !(incident == along))
      trace_.hits.back().wave = {dot(incident, along), dot(incident, across), incident.y};
  }
}

void LineWalker::bend(Group group, Vec3d direction) {
  query_.ray.origin = query_.ray.origin + at_.walked_m * query_.ray.direction;
  query_.ray.direction = at_.wave = direction;
  query_.left_behind.clear();
  for (const Crossing& c : group) query_.left_behind.emplace_back(c.surface, c.triangle);
  at_.walked_m = 0;
  if (++at_.bends > kMaxBends) at_.alive = false;
}

// A wall in the transducer's face is no interface, as two walls in one place are one: a probe that
// stands on a surface within rounding is in the medium behind it. Returns the first crossing
// beyond.
std::size_t LineWalker::crossAtFace(Group crossings, InsideSet& inside) const {
  const double face_m = at_.walked_m + settings_.face_m;
  std::size_t first = 0;
  for (; first < crossings.size() && crossings[first].distance_m <= face_m; ++first)
    if (const std::size_t s = index(crossings[first].surface); !settings_.surfaces[s].membrane)
      inside[s] = crossings[first].entering;
  return first;
}

void LineWalker::advance(const RayCrossings& met) {
  InsideSet inside = met.inside;
  const std::vector<Crossing>& all = met.crossings;
  const std::size_t first = at_.path_m == 0 ? crossAtFace(all, inside) : 0;
  if (settings_.note_hits && at_.path_m == 0) trace_.inside = inside;
  ruling_.find(inside);
  at_.medium = ruling_.medium();
  const int bends_before = at_.bends;
  for (std::size_t begin = first, end = 0; begin < all.size(); begin = end) {
    const double distance_m = all[begin].distance_m;
    end = begin + 1;
    while (end < all.size() && all[end].distance_m - distance_m <= settings_.thin_layer_m) ++end;
    const bool lost = mirrored() && !layer_.reaches(at_.path_m + distance_m - at_.walked_m);
    if (!lost) walkTo(distance_m);
    if (mirrored() && (lost || !at_.alive)) return endAtMirror();
    if (!at_.alive) return;
    const Group group(&all[begin], end - begin);
    for (const Crossing& c : group)
      if (const std::size_t s = index(c.surface); !settings_.surfaces[s].membrane)
        ruling_.cross(s, c.entering, inside);
    const MediumId after = ruling_.medium();
    const std::size_t first_hit = trace_.hits.size();
    if (settings_.note_hits) noteHits(group, after);
    for (auto c = group.begin(); at_.alive && c != group.end(); ++c) {
      if (!settings_.surfaces[index(c->surface)].membrane) continue;
      // At a vertex a sheet may be met by several of its triangles: it is passed once.
      const auto same = [&](const Crossing& other) { return other.surface == c->surface; };
      if (std::find_if(group.begin(), c, same) == c) passMembrane(*c);
    }
    if (at_.alive && after != at_.medium) passInterface(group, after, first_hit);
    if (!at_.alive) return;
    if (at_.bends != bends_before) {
      query_.inside = inside;
      return;
    }
  }
  if (mirrored()) return endAtMirror();
  walkTo(std::numeric_limits<double>::infinity());
}

}  // namespace echocine
