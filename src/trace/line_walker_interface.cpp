// What an interface does to the line that meets it: the angle of incidence, the echo, the loss, and
// the direction behind it.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "trace/line_walker.h"

namespace echocine {

namespace {

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
void LineWalker::addEcho(double reflected, double cos_i, const Crossing& crossing, MediumId after) {
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

}  // namespace echocine
