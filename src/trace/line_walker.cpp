#include "trace/line_walker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace echocine {

namespace {

// A ray that bends more often is caught in a wedge; what it could still send back is nothing.
constexpr int kMaxBends = 1000;

// Snell's direction behind an interface. Beyond the facet's critical angle but not the smooth
// normal's it may point back to the side of the facet from which the ray came, while by the facets
// it has crossed: such a ray goes on straight.
std::optional<Vec3d> bentDirection(const Crossing& crossing, Vec3d direction, const Medium& from,
                                   const Medium& to) {
  const std::optional<Vec3d> bent =
      refracted(direction, crossing.normal, from.sound_speed_m_s, to.sound_speed_m_s);
  const Vec3d facet = crossing.facet_normal;
  const bool back = bent && dot(facet, *bent) * dot(facet, direction) < 0;
  return back ? std::nullopt : bent;
}

}  // namespace

LineWalker::LineWalker(const TraceSettings& settings, const Ray& start, const InsideSet& inside,
                       LineTrace& trace, double start_m)
    : settings_(settings),
      trace_(trace),
      query_{start, inside, {}},
      wave_(start.direction),
      walked_m_(start_m) {
  trace_.clear();
}

// Where closed structures overlap the highest priority wins, among equals the later in the scene.
bool LineWalker::rules(std::size_t surface, std::size_t over) const {
  if (over == kNoSurface) return true;
  const int priority = settings_.surfaces[surface].priority,
            of_other = settings_.surfaces[over].priority;
  return priority > of_other || (priority == of_other && surface >= over);
}

void LineWalker::findRuling(const InsideSet& inside) {
  ruling_ = kNoSurface;
  if (inside.none()) return;
  for (std::size_t s = 0; s < settings_.surfaces.size(); ++s)
    if (inside[s] && rules(s, ruling_)) ruling_ = s;
}

MediumId LineWalker::rulingMedium() const {
  return ruling_ == kNoSurface ? settings_.background : settings_.surfaces[ruling_].medium;
}

// Only who leaves the surface that rules has to ask all others.
void LineWalker::cross(const Crossing& crossing, InsideSet& inside) {
  const std::size_t s = index(crossing.surface);
  if (settings_.surfaces[s].membrane) return;
  inside[s] = crossing.entering;
  if (crossing.entering) {
    if (rules(s, ruling_)) ruling_ = s;
  } else if (s == ruling_) {
    findRuling(inside);
  }
}

// Eq. 3 along one medium, there and back: A grows by 4 alpha per metre.
void LineWalker::walkTo(double distance_m) {
  const Medium& medium = settings_.media[index(medium_)];
  const double path_per_depth =
      settings_.travel_time ? medium.sound_speed_m_s / kScannerSpeed : 1.0;
  const double exponent_per_path = settings_.attenuation ? 4 * medium.attenuation_np_per_m : 0.0;
  double step_m = distance_m - walked_m_;
  const double end_depth_m = depth_m_ + (settings_.travel_time ? step_m / path_per_depth : step_m);
  if (end_depth_m >= settings_.max_depth_m) {
    step_m = (settings_.max_depth_m - depth_m_) * path_per_depth;
    alive_ = false;
  }
  const double next_depth_m = alive_ ? end_depth_m : settings_.max_depth_m;
  const double eta_b = settings_.backscatter ? medium.backscatter_per_m_sr : 0.0;
  trace_.segments.push_back({.begin_depth_m = depth_m_,
                             .end_depth_m = next_depth_m,
                             .begin_path_m = path_m_,
                             .path_per_depth = path_per_depth,
                             .begin_exponent = exponent_,
                             .exponent_per_m = exponent_per_path * path_per_depth,
                             .strength_m2_sr = eta_b * settings_.unit_volume_m3 * passed_,
                             .medium = medium_});
  walked_m_ += step_m;
  path_m_ += step_m;
  depth_m_ = next_depth_m;
  exponent_ += exponent_per_path * step_m;
}

// The direction by which the angle of incidence at a crossing is taken: the ray's own, or Snell's,
// which a straight ray carries along for this alone. Where that would not meet this side of the
// surface the bent ray passes it by, and the ray's own direction counts again.
Vec3d LineWalker::incidentAt(const Crossing& crossing) {
  const Vec3d direction = query_.ray.direction;
  if (dot(wave_, crossing.normal) * dot(direction, crossing.normal) <= 0) wave_ = direction;
  return wave_;
}

InterfaceLaw LineWalker::lawAt(const Crossing& crossing, const Medium& from, const Medium& to) {
  const double cos_i = std::min(std::abs(dot(wave_, crossing.normal)), 1.0);
  return interfaceLaw(from.impedance_kg_m2_s, from.sound_speed_m_s, to.impedance_kg_m2_s,
                      to.sound_speed_m_s, cos_i);
}

// What of R comes back: section 2.1's W without the structure's gain.
double LineWalker::sentBack(const InterfaceLaw& law, const Medium& from, const Medium& to) const {
  if (!settings_.reflection_cap) return law.R;
  return cappedReflectance(law.R, from.impedance_kg_m2_s, to.impedance_kg_m2_s);
}

// What the interface sends to the transducer, added to what is lost before it.
void LineWalker::addEcho(double reflected, double cos_i, const Crossing& crossing,
                         MediumId after) {
  if (!settings_.reflection || settings_.cells == EchoCells::contours || reflected == 0) return;
  const SurfaceTraits& surface = settings_.surfaces[index(crossing.surface)];
  const double towards = dot(query_.ray.direction, crossing.normal);
  const double cosine = std::copysign(std::max(std::abs(towards), 1e-3), towards);
  const double W = surface.gain * reflected;
  trace_.echoes.push_back({depth_m_, passed_ * nonSpecularReturn(W, cos_i, surface.exponent),
                           exponent_, (1 / cosine) * crossing.normal, crossing.surface, medium_,
                           after, query_.ray.origin + walked_m_ * query_.ray.direction});
}

// Forward times backward transmission, T_12 T_21 = (1 - R)^2. Total reflection ends the ray
// whatever effects are on: there is no direction in which it could go on.
void LineWalker::loseAt(const InterfaceLaw& law) {
  if (law.total) {
    alive_ = false;
    for (std::size_t h = trace_.hits.size(); h-- > 0 && trace_.hits[h].path_m == path_m_;)
      trace_.hits[h].ends = true;
  }
  if (settings_.transmission_loss) passed_ *= law.through * law.through;
}

// The crossing whose normal and lobe stand for a group of coincident surfaces.
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

// For integration over cells: every crossing with the media and losses of this line. Of coincident
// surfaces the deciding one is seen.
void LineWalker::noteHits(Group group, MediumId after) {
  const Medium& medium = settings_.media[index(medium_)];
  const Crossing& decided = deciding(group);
  const Vec3d along = query_.ray.direction, across = echocine::cross(Vec3d{0, 1, 0}, along);
  const Vec3d incident = incidentAt(decided);
  for (const Crossing& c : group) {
    const SurfaceTraits& surface = settings_.surfaces[index(c.surface)];
    const bool seen = surface.membrane || (after != medium_ && &c == &decided);
    trace_.hits.push_back(
        {.surface = c.surface,
         .entering = c.entering,
         .seen = seen,
         .before = medium_,
         .after = surface.membrane ? surface.medium : after,
         .point = query_.ray.origin + walked_m_ * along,
         .path_m = path_m_,
         .depth_m = depth_m_,
         .path_per_depth = settings_.travel_time ? medium.sound_speed_m_s / kScannerSpeed : 1.0,
         .exponent = exponent_,
         .exponent_per_path = settings_.attenuation ? 4 * medium.attenuation_np_per_m : 0.0,
         .passed = passed_});
    if (settings_.snell_angles && !(incident == along))
      trace_.hits.back().wave = {dot(incident, along), dot(incident, across), incident.y};
  }
}

// The phase x of layer_echoes.h between the last face and this one.
double LineWalker::phaseSinceFace(const Crossing& crossing) const {
  const double k = 2 * std::numbers::pi * settings_.frequency_hz /
                   settings_.media[index(medium_)].sound_speed_m_s;
  const double thickness_m =
      (path_m_ - face_path_m_) * std::abs(dot(query_.ray.direction, crossing.normal));
  return 2 * k * thickness_m * std::abs(dot(wave_, crossing.normal));
}

// An interface that the pulse holds together with those before it: all their echoes and the loss
// behind them are worked out anew.
void LineWalker::joinLayer(const InterfaceLaw& law, double phase, std::size_t first_hit,
                           std::size_t first_echo) {
  const bool alone = layer_.empty();
  const double passed = layer_.passed();
  double base = 0;
  if (trace_.echoes.size() > first_echo) {
    Echo& echo = trace_.echoes.back();
    if (!alone && passed_ > 0) echo.intensity *= passed / passed_;
    base = echo.intensity;
  }
  layer_.add(
      {law.amplitude, layer_.lastPhase() + phase, base, first_echo, first_hit, trace_.hits.size()});
  face_path_m_ = path_m_;
  loseAt(law);
  if (alone) return;
  const LayerEchoes::Together together =
      layer_.together(settings_.pulse_cycles, settings_.transmission_loss);
  const std::span<const LayerEchoes::Face> faces = layer_.faces();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (faces[i].base > 0)
      trace_.echoes[faces[i].echo].intensity = faces[i].base * together.scale[i];
    for (std::size_t h = faces[i].hit; h < faces[i].hits_end; ++h)
      if (!settings_.surfaces[index(trace_.hits[h].surface)].membrane)
        trace_.hits[h].passed = passed * together.scale[i];
  }
  if (settings_.transmission_loss) passed_ = passed * together.through * together.through;
}

void LineWalker::passInterface(Group group, MediumId after, std::size_t first_hit) {
  const Medium& from = settings_.media[index(medium_)];
  const Medium& to = settings_.media[index(after)];
  if (sameInterface(from, to)) {
    medium_ = after;
    return;
  }
  const Crossing& crossing = deciding(group);
  const Vec3d incident = incidentAt(crossing);
  const InterfaceLaw law = lawAt(crossing, from, to);
  const std::size_t first_echo = trace_.echoes.size();
  const double phase = layer_.empty() ? 0 : phaseSinceFace(crossing);
  // Faces are together while one pulse holds them, by their phase and on the line.
  const double pulse_m = settings_.pulse_cycles * settings_.wavelength_m / 2;
  const bool held =
      phase < 2 * std::numbers::pi * settings_.pulse_cycles && path_m_ - face_path_m_ < pulse_m;
  if (law.total || layer_.full() || !held) layer_.clear(passed_);
  addEcho(sentBack(law, from, to), std::min(std::abs(dot(incident, crossing.normal)), 1.0),
          crossing, after);
  medium_ = after;
  if (settings_.thin_layers && !law.total)
    joinLayer(law, layer_.empty() ? 0 : phase, first_hit, first_echo);
  else
    loseAt(law);
  if (!alive_ || from.sound_speed_m_s == to.sound_speed_m_s) return;
  if (!settings_.refraction && !settings_.snell_angles) return;
  const auto bent = bentDirection(crossing, incident, from, to);
  if (!bent) return;
  if (settings_.refraction) return bend(group, *bent);
  wave_ = *bent;
}

// Two interfaces of a sheet that is thin against a sample: both echoes arrive together, each with
// its own angle. R is the same from the sheet outwards.
void LineWalker::passMembrane(const Crossing& crossing) {
  const SurfaceTraits& surface = settings_.surfaces[index(crossing.surface)];
  const Medium& around = settings_.media[index(medium_)];
  const Medium& sheet = settings_.media[index(surface.medium)];
  const double cos_i = std::min(std::abs(dot(incidentAt(crossing), crossing.normal)), 1.0);
  const InterfaceLaw law = lawAt(crossing, around, sheet);
  addEcho(sentBack(law, around, sheet), cos_i, crossing, surface.medium);
  loseAt(law);
  if (!alive_) return;
  const double cos_t =
      transmissionCosine(cos_i, around.sound_speed_m_s, sheet.sound_speed_m_s).value_or(0);
  addEcho(sentBack(law, around, sheet), cos_t, crossing, surface.medium);
  loseAt(law);
  layer_.clear(passed_);  // the sheet's loss lies between what is before it and behind
}

void LineWalker::bend(Group group, Vec3d direction) {
  query_.ray.origin = query_.ray.origin + walked_m_ * query_.ray.direction;
  query_.ray.direction = wave_ = direction;
  query_.left_behind.clear();
  for (const Crossing& c : group) query_.left_behind.emplace_back(c.surface, c.triangle);
  walked_m_ = 0;
  if (++bends_ > kMaxBends) alive_ = false;
}

// A wall in the transducer's face is no interface, as two walls in one place are one: a probe that
// stands on a surface within rounding is in the medium behind it. Returns the first crossing
// beyond.
std::size_t LineWalker::crossAtFace(Group crossings, InsideSet& inside) const {
  const double face_m = walked_m_ + settings_.face_m;
  std::size_t first = 0;
  for (; first < crossings.size() && crossings[first].distance_m <= face_m; ++first)
    if (const std::size_t s = index(crossings[first].surface); !settings_.surfaces[s].membrane)
      inside[s] = crossings[first].entering;
  return first;
}

void LineWalker::advance(const RayCrossings& met) {
  InsideSet inside = met.inside;
  const std::vector<Crossing>& all = met.crossings;
  const std::size_t first = path_m_ == 0 ? crossAtFace(all, inside) : 0;
  findRuling(inside);
  medium_ = rulingMedium();
  const int bends_before = bends_;
  for (std::size_t begin = first, end = 0; begin < all.size(); begin = end) {
    const double distance_m = all[begin].distance_m;
    end = begin + 1;
    while (end < all.size() && all[end].distance_m - distance_m <= settings_.thin_layer_m) ++end;
    walkTo(distance_m);
    if (!alive_) return;
    const Group group(&all[begin], end - begin);
    for (const Crossing& c : group) cross(c, inside);
    const MediumId after = rulingMedium();
    const std::size_t first_hit = trace_.hits.size();
    if (settings_.note_hits) noteHits(group, after);
    for (auto c = group.begin(); alive_ && c != group.end(); ++c) {
      if (!settings_.surfaces[index(c->surface)].membrane) continue;
      // At a vertex a sheet may be met by several of its triangles: it is passed once.
      const auto same = [&](const Crossing& other) { return other.surface == c->surface; };
      if (std::find_if(group.begin(), c, same) == c) passMembrane(*c);
    }
    if (alive_ && after != medium_) passInterface(group, after, first_hit);
    if (!alive_) return;
    if (bends_ != bends_before) {
      query_.inside = inside;
      return;
    }
  }
  walkTo(std::numeric_limits<double>::infinity());
}

}  // namespace echocine
