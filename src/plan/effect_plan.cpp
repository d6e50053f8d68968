#include "plan/effect_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/units.h"
#include "plan/beam_findings.h"
#include "plan/media_in_use.h"
#include "plan/picture_plan.h"
#include "scene/names.h"
#include "scene/scan_geometry.h"

namespace echocine {

bool wants(const Scene& scene, Channel channel) {
  const std::vector<Channel>& list = scene.output.channels;
  return scene.output.exr && std::find(list.begin(), list.end(), channel) != list.end();
}

bool wantsPicture(const Scene& scene) {
  return scene.output.pictures() || wants(scene, Channel::display);
}

bool wantsIntensity(const Scene& scene, bool reflected) {
  return wantsPicture(scene) || wants(scene, Channel::y) || wants(scene, Channel::unattenuated) ||
         wants(scene, reflected ? Channel::reflection : Channel::backscatter);
}

std::string EffectDecision::name() const {
  return effect == Effect::channel ? fmt::format("channel {}", channelName(channel))
                                   : std::string(nameOf(effect));
}

EffectDecision& EffectPlan::decision(Effect effect) {
  return *std::find_if(decisions.begin(), decisions.end(),
                       [&](const EffectDecision& d) { return d.effect == effect; });
}

const EffectDecision& EffectPlan::decision(Effect effect) const {
  return const_cast<EffectPlan*>(this)->decision(effect);
}

namespace {

bool decide(EffectPlan& plan, Effect effect, Switch wanted, const Finding& found) {
  Finding decided = found;
  if (wanted == Switch::on)
    decided = {true, found.on ? "the scene requests it"
                              : "the scene requests it, although " + found.reason};
  if (wanted == Switch::off)
    decided = {false, found.on ? "the scene disables it, although " + found.reason
                               : "the scene disables it"};
  plan.decisions.push_back({effect, decided.on, decided.reason});
  return decided.on;
}

Finding interfaces(const Scene& scene) {
  const std::vector<const Medium*> used = mediaInUse(scene);
  for (const Medium* m : used)
    if (!sameInterface(*m, *used[0]))
      return {true, fmt::format("{} and {} differ in impedance or speed", used[0]->name, m->name)};
  return {false, "all media have the same impedance and speed, so no interface reflects"};
}

Finding echoes(const Scene& scene) {
  if (!wantsIntensity(scene, true)) return {false, "no requested output contains interface echoes"};
  return interfaces(scene);
}

Finding lobes(const Scene& scene, bool reflection) {
  if (!reflection) return {false, "there are no interface echoes to weigh"};
  for (const Structure& s : scene.structures)
    if (s.reflection_exponent != 0)
      return {true, fmt::format("{} sends back cos^{:g} of what it reflects", s.name,
                                s.reflection_exponent)};
  return {false, "every structure's exponent is 0, so the lobe is the same for all angles"};
}

Finding losses(const Scene& scene) {
  if (!wantsIntensity(scene, true) && !wantsIntensity(scene, false))
    return {false, "no requested output contains intensities"};
  return interfaces(scene);
}

// A membrane bends nothing, so only the media that enclose something count.
Finding bending(const Scene& scene) {
  const Medium& outside = scene.medium(scene.background);
  for (const Structure& s : scene.structures)
    if (!s.membrane && scene.medium(s.medium).sound_speed_m_s != outside.sound_speed_m_s)
      return {true, fmt::format("{} ({:g} m/s) bends rays from {} ({:g} m/s)", s.name,
                                scene.medium(s.medium).sound_speed_m_s, outside.name,
                                outside.sound_speed_m_s)};
  return {false, "every structure has the sound speed of its surroundings, so no ray bends"};
}

// The angles that the interface law depends on.
Finding snellAngles(const Scene& scene, const EffectPlan& plan) {
  if (!plan.reflection && !plan.transmission_loss)
    return {false, "no angle of incidence is requested"};
  const Finding bends = bending(scene);
  if (!bends.on) return bends;
  return {true, "straight rays meet interfaces at the angles of bent ones"};
}

Finding reflectionCap(const Scene& scene, const EffectPlan& plan) {
  if (!plan.reflection) return {false, "there are no interface echoes to cap"};
  if (!speedsDiffer(scene))
    return {false, "all media have one sound speed, so R is that of normal incidence"};
  return {true, "no wall sends back more than it would at normal incidence"};
}

Finding thinLayers(const Scene& scene, const EffectPlan& plan) {
  if (!plan.reflection && !plan.transmission_loss)
    return {false, "no echo or loss of an interface is requested"};
  return {true, fmt::format("interfaces less than {:.2g} mm apart echo as one pulse",
                            millimetresFromMetres(scene.signal.pulse_cycles * kScannerSpeed /
                                                  scene.probe.frequency_hz / 2))};
}

Finding attenuating(const Scene& scene) {
  const std::vector<const Medium*> used = mediaInUse(scene);
  if (std::none_of(used.begin(), used.end(),
                   [](const Medium* m) { return m->attenuation_np_per_m > 0; }))
    return {false, "no medium attenuates"};
  for (const Channel c :
       {Channel::y, Channel::attenuation, Channel::reflection, Channel::backscatter})
    if (wants(scene, c)) return {true, fmt::format("channel {} holds it", channelName(c))};
  if (wantsPicture(scene) && scene.signal.tgc != Tgc::perfect)
    return {true,
            scene.signal.tgc == Tgc::none   ? "no time gain undoes it"
            : scene.signal.tgc == Tgc::mean ? "the mean time gain undoes only what all lines share"
            : scene.signal.tgc == Tgc::nominal ? "the nominal gain undoes the same on all lines"
                                               : "a table of gains does not undo it exactly"};
  return {false, "perfect TGC undoes it and no received intensity was requested"};
}

Finding scattering(const Scene& scene) {
  if (!wantsIntensity(scene, false)) return {false, "no requested output contains backscatter"};
  std::string kinds;
  for (const Medium* m : mediaInUse(scene))
    if (m->backscatter_per_m_sr > 0 && kinds.find(m->name) == std::string::npos)
      kinds += (kinds.empty() ? "" : ", ") + m->name;
  if (kinds.empty()) return {false, "no medium scatters back"};
  return {true, kinds + " scatter back"};
}

Finding spreading(const Scene& scene, bool backscatter) {
  if (!backscatter) return {false, "nothing is scattered back"};
  for (const Channel c : {Channel::y, Channel::unattenuated, Channel::backscatter})
    if (wants(scene, c)) return {true, fmt::format("channel {} holds it", channelName(c))};
  if (scene.signal.spread == Spread::keep) return {true, "signal.spread keeps it"};
  return {false, "the display compensates it and no received intensity was requested"};
}

void add(EffectPlan& plan, Effect effect, bool on, std::string reason, Channel channel = {}) {
  plan.decisions.push_back({effect, on, std::move(reason), channel});
}

// A row for each kind of truth, and for each of its channels that is requested.
void planTruth(const Scene& scene, EffectPlan& plan) {
  const TruthSettings& t = scene.truth;
  for (const auto& [effect, on] :
       {std::pair(Effect::truth_labels, t.labels), std::pair(Effect::truth_contours, t.contours),
        std::pair(Effect::truth_tracks, t.tracks), std::pair(Effect::truth_function, t.function)})
    add(plan, effect, on, on ? "requested in truth.write" : "not asked for");
  for (const Channel c : kTruthChannels)
    if (wants(scene, c))
      add(plan, Effect::channel, true,
          isVelocity(c)
              ? "requested in output.channels; blood has no flow field, so it is NaN there"
              : "requested in output.channels",
          c);
}

// A curve of depth that is applied to every line, and what asks for it.
Finding pathGain(const Scene& scene, const EffectPlan& plan) {
  if (!wantsPicture(scene)) return {false, "no picture is requested"};
  switch (scene.signal.tgc) {
    case Tgc::perfect:
      return {false, "perfect TGC omits attenuation instead of applying a gain"};
    case Tgc::none:
      return {false, "no time gain is requested"};
    case Tgc::table:
      return {true, "a table of gains over depth"};
    case Tgc::nominal:
    case Tgc::mean:
      break;
  }
  if (!plan.attenuation) return {false, "there is no attenuation to undo"};
  if (scene.signal.tgc == Tgc::nominal)
    return {true, "one curve of depth, by a nominal attenuation"};
  return {true, "one curve of depth that undoes the loop's mean attenuation"};
}

Finding timeGain(const Scene& scene, const EffectPlan& plan) {
  Finding gain = pathGain(scene, plan);
  const SignalSettings& s = scene.signal;
  if (s.near_gain_db == 0 || !wantsPicture(scene)) return gain;
  return {true, fmt::format("{}; {:g} dB at the face (signal.near_gain_db)", gain.reason,
                            s.near_gain_db)};
}

void planRolling(const Scene& scene, EffectPlan& plan) {
  const int together = scene.accuracy.rolling_lines;
  plan.rolling = scene.acquisition.rolling && scene.probe.lines > together;
  add(plan, Effect::rolling, plan.rolling,
      !scene.acquisition.rolling ? "acquisition.rolling is off"
      : !plan.rolling            ? "all lines share one instant (accuracy.rolling_lines)"
      : together == 1            ? "each line at its own instant"
                      : fmt::format("each {} lines at the instant of their middle", together));
}

void planSignal(const Scene& scene, EffectPlan& plan) {
  const bool picture = wantsPicture(scene);
  const Finding gain = timeGain(scene, plan);
  add(plan, Effect::tgc, gain.on, gain.reason);
  add(plan, Effect::log_compression, picture,
      picture ? fmt::format("{:g} dB for the picture", scene.signal.dynamic_range_db)
              : "no picture is requested");
  planGreyMap(scene, plan);
  const bool labels = wants(scene, Channel::medium);
  add(plan, Effect::labels, labels,
      labels ? "channel medium.id is requested" : "channel medium.id is not requested");
  for (const Channel c : kAllChannels) {
    if (c == Channel::medium || (c == Channel::y && !wants(scene, c))) continue;
    add(plan, Effect::channel, wants(scene, c),
        wants(scene, c) ? "requested in output.channels" : "not asked for", c);
  }
  planTruth(scene, plan);
}

}  // namespace

EffectPlan planEffects(const Scene& scene) {
  EffectPlan plan;
  const EffectSwitches& wanted = scene.effects;
  plan.contrast = mediaDiffer(scene);
  plan.reflection = decide(plan, Effect::reflection, wanted.reflection, echoes(scene));
  plan.lobe = decide(plan, Effect::lobe, wanted.lobe, lobes(scene, plan.reflection));
  plan.transmission_loss =
      decide(plan, Effect::transmission_loss, wanted.transmission_loss, losses(scene));
  plan.refraction = decide(plan, Effect::refraction, wanted.refraction, bending(scene));
  // Where no speed differs bent rays are straight ones; those know the contour between lines.
  if (plan.refraction && !bending(scene).on) {
    plan.refraction = plan.decisions.back().on = false;
    plan.decisions.back().reason = "the scene requests it, but " + bending(scene).reason;
  }
  plan.snell_angles =
      decide(plan, Effect::snell_angles, wanted.snell_angles, snellAngles(scene, plan));
  plan.reflection_cap =
      decide(plan, Effect::reflection_cap, wanted.reflection_cap, reflectionCap(scene, plan));
  plan.thin_layers = decide(plan, Effect::thin_layers, wanted.thin_layers, thinLayers(scene, plan));
  plan.attenuation = decide(plan, Effect::attenuation, wanted.attenuation, attenuating(scene));
  plan.backscatter = decide(plan, Effect::backscatter, wanted.backscatter, scattering(scene));
  plan.spread = decide(plan, Effect::spread, wanted.spread, spreading(scene, plan.backscatter));
  plan.beam_width = decide(plan, Effect::beam_width, wanted.beam_width, findBeamWidth(scene));
  const bool elevation = decide(plan, Effect::elevation, wanted.elevation, findElevation(scene));
  plan.elevation = elevation && severalRays(scene);
  plan.lateral_rays = plan.beam_width && lateralRays(scene);
  if (plan.elevation || plan.lateral_rays) plan.rays_per_beam = scene.accuracy.rays_per_beam;
  if (elevation && severalSlices(scene)) plan.elevation_slices = scene.accuracy.elevation_slices;
  plan.travel_time = decide(plan, Effect::travel_time, wanted.travel_time,
                            {false, "echoes are placed at their path length"});
  planPulse(scene, plan);
  planTrabeculae(scene, plan);
  planLeaflets(scene, plan);
  planChordae(scene, plan);
  planAnnulus(scene, plan);
  planSpeckle(scene, plan);
  planArtefacts(scene, plan);
  planRolling(scene, plan);
  planSignal(scene, plan);
  return plan;
}

}  // namespace echocine
