// Effect of an interface on the line that meets it: the angle of incidence, the echo, the loss, and
// the direction behind it.

#include <algorithm>
#include <cmath>

#include "trace/line_walker.h"

namespace echocine {

namespace {

// Snell's direction behind an interface. Beyond the facet's critical angle but not the smooth
// normal's it may point back to the side of the facet from which the ray came, while by the facets
// it has crossed: such a ray goes on straight.
std::optional<Vec3d> bentDirection(const Crossing& crossing, Vec3d direction, double c_from,
                                   double c_to) {
  const std::optional<Vec3d> bent = refracted(direction, crossing.normal, c_from, c_to);
  const Vec3d facet = crossing.facet_normal;
  const bool back = bent && dot(facet, *bent) * dot(facet, direction) < 0;
  return back ? std::nullopt : bent;
}

LayerMedium layerMedium(const Medium& medium) {
  return {medium.impedance_kg_m2_s, medium.sound_speed_m_s};
}

}  // namespace

// The direction by which the angle of incidence at a crossing is taken: the ray's own, or Snell's,
// which a straight ray carries along for this alone. Where that would not meet this side of the
// surface the bent ray passes it by, and the ray's own direction counts again.
Vec3d LineWalker::incidentAt(const Crossing& crossing) {
  const Vec3d direction = query_.ray.direction;
  if (dot(at_.wave, crossing.normal) * dot(direction, crossing.normal) <= 0) at_.wave = direction;
  return at_.wave;
}

InterfaceLaw LineWalker::lawAt(const Crossing& crossing, const Medium& from, const Medium& to) {
  const double cos_i = std::min(std::abs(dot(at_.wave, crossing.normal)), 1.0);
  return interfaceLaw(from.impedance_kg_m2_s, from.sound_speed_m_s, to.impedance_kg_m2_s,
                      to.sound_speed_m_s, cos_i);
}

// The part of R that comes back: section 2.1's W without the structure's gain.
double LineWalker::sentBack(const InterfaceLaw& law, const Medium& from, const Medium& to) const {
  if (!settings_.reflection_cap) return law.R;
  return cappedReflectance(law.R, from.impedance_kg_m2_s, to.impedance_kg_m2_s);
}

// Adds the echo that the interface sends to the transducer behind losses of `passed`.
void LineWalker::addEcho(double reflected, double passed, double cos_i, const Crossing& crossing,
                         MediumId after) {
  if (!settings_.reflection || settings_.cells == EchoCells::contours || reflected == 0) return;
  const SurfaceTraits& surface = settings_.surfaces[index(crossing.surface)];
  const double towards = dot(query_.ray.direction, crossing.normal);
  const double cosine = std::copysign(std::max(std::abs(towards), 1e-3), towards);
  const double W = surface.gain * reflected;
  trace_.echoes.push_back({at_.depth_m, passed * nonSpecularReturn(W, cos_i, surface.exponent),
                           at_.exponent, (1 / cosine) * crossing.normal, crossing.surface,
                           at_.medium, after,
                           query_.ray.origin + at_.walked_m * query_.ray.direction});
}

// `through`: forward times backward transmission. Total reflection ends the ray whatever effects
// are on: there is no direction in which it could go on.
void LineWalker::loseAt(const InterfaceLaw& law, double through) {
  if (law.total && settings_.beyond_mirrors) return;
  if (law.total) {
    reflectAll(0);
    return endAtMirror();
  }
  if (settings_.transmission_loss) at_.passed *= through;
}

// Total reflection. Where a layer begins here the line goes on until it is known how thick that is.
void LineWalker::reflectAll(double speed_before_m_s) {
  mirror_ = {true,
             speed_before_m_s,
             at_.path_m,
             trace_.segments.size(),
             trace_.echoes.size(),
             trace_.hits.size()};
}

void LineWalker::endAtMirror() {
  trace_.segments.resize(mirror_.segments);
  trace_.echoes.resize(mirror_.echoes);
  trace_.hits.resize(mirror_.hits);
  for (std::size_t h = mirror_.hits; h-- > 0 && trace_.hits[h].path_m == mirror_.path_m;)
    trace_.hits[h].ends = true;
  at_.alive = false;
}

// The interface as a face of a stack of layers. Behind a total reflection there is no ray whose
// angle the law could take: whether the wave goes on is decided by the medium before that.
LayerEchoes::Meeting LineWalker::meetingAt(const Crossing& crossing, const InterfaceLaw& law,
                                           const Medium& from, const Medium& to) const {
  const double along = dot(query_.ray.direction, crossing.normal);
  const double cos_i = std::min(std::abs(dot(at_.wave, crossing.normal)), 1.0);
  const bool total = mirror_.met
                         ? !transmissionCosine(cos_i, mirror_.speed_before_m_s, to.sound_speed_m_s)
                         : law.total;
  return {layerMedium(from),
          layerMedium(to),
          cos_i,
          law.amplitude,
          total,
          at_.path_m,
          std::abs(along),
          along < 0 ? crossing.normal : -crossing.normal};
}

// Adds a face to the layers that the pulse holds: their echoes and the loss behind them are worked
// out anew.
void LineWalker::joinLayer(const LayerEchoes::Meeting& meeting, const InterfaceLaw& law,
                           std::size_t first_hit, std::size_t first_echo) {
  const bool alone = layer_.empty();
  const double base = trace_.echoes.size() > first_echo ? trace_.echoes.back().intensity : 0;
  layer_.add(meeting,
             {meeting.amplitude, meeting.total, base, first_echo, first_hit, trace_.hits.size()});
  if (alone) {
    if (settings_.transmission_loss) at_.passed *= law.through * law.through;
    return;
  }
  const LayerEchoes::Together together = layer_.together(settings_.transmission_loss);
  const std::span<const LayerEchoes::Face> faces = layer_.faces();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (faces[i].base > 0)
      trace_.echoes[faces[i].echo].intensity = faces[i].base * together.scale[i];
    for (std::size_t h = faces[i].hit; h < faces[i].hits_end; ++h)
      if (!settings_.surfaces[index(trace_.hits[h].surface)].membrane)
        trace_.hits[h].passed = layer_.passed() * together.scale[i];
  }
  at_.passed = layer_.passed() * together.passed_twice;
}

void LineWalker::passInterface(Group group, MediumId after, std::size_t first_hit) {
  const Medium& from = settings_.media[index(at_.medium)];
  const Medium& to = settings_.media[index(after)];
  if (sameInterface(from, to)) {
    at_.medium = after;
    return;
  }
  const Crossing& crossing = deciding(group);
  const Vec3d incident = incidentAt(crossing);
  const InterfaceLaw law = lawAt(crossing, from, to);
  const LayerEchoes::Meeting meeting = meetingAt(crossing, law, from, to);
  const bool held = settings_.thin_layers && layer_.holds(meeting);
  if (mirrored() && !held) return endAtMirror();
  if (!held) layer_.clear(at_.passed);
  const std::size_t first_echo = trace_.echoes.size();
  addEcho(sentBack(law, from, to), layer_.passed(), meeting.cos_i, crossing, after);
  at_.medium = after;
  if (settings_.thin_layers)
    joinLayer(meeting, law, first_hit, first_echo);
  else
    loseAt(law, law.through * law.through);  // T_12 T_21
  if (!at_.alive) return;
  const double c_from = mirror_.met ? mirror_.speed_before_m_s : from.sound_speed_m_s;
  mirror_.met = false;
  if (meeting.total) return reflectAll(c_from);
  if (c_from == to.sound_speed_m_s || !(settings_.refraction || settings_.snell_angles)) return;
  const auto bent = bentDirection(crossing, incident, c_from, to.sound_speed_m_s);
  if (!bent) return;
  if (settings_.refraction) return bend(group, *bent);
  at_.wave = *bent;
}

// Two interfaces of a sheet that is thin against a sample: both echoes arrive together, each with
// its own angle. R is the same from the sheet outwards. Sound reverberates between the faces; its
// intensities add, since no thickness is stated that could fix a phase. The second face's echoes
// sum to R (1-R)^2 (1 + R^2 + R^4 + ...) = R (1-R)/(1+R), and what goes through to (1-R)/(1+R) per
// way.
void LineWalker::passMembrane(const Crossing& crossing) {
  if (mirrored()) return endAtMirror();
  const SurfaceTraits& surface = settings_.surfaces[index(crossing.surface)];
  const Medium& around = settings_.media[index(at_.medium)];
  const Medium& sheet = settings_.media[index(surface.medium)];
  const double cos_i = std::min(std::abs(dot(incidentAt(crossing), crossing.normal)), 1.0);
  const InterfaceLaw law = lawAt(crossing, around, sheet);
  const double through = law.through / (1 + law.R);
  addEcho(sentBack(law, around, sheet), at_.passed, cos_i, crossing, surface.medium);
  loseAt(law, through);
  if (!at_.alive) return;
  const double cos_t =
      transmissionCosine(cos_i, around.sound_speed_m_s, sheet.sound_speed_m_s).value_or(0);
  addEcho(sentBack(law, around, sheet), at_.passed, cos_t, crossing, surface.medium);
  loseAt(law, through);
  layer_.clear(at_.passed);  // the sheet's loss lies between what is before it and behind
}

}  // namespace echocine
