#include "scene/effect_plan.h"

#include <fmt/format.h>

#include <algorithm>

namespace echocine {

bool wants(const Scene& scene, Channel channel) {
  const std::vector<Channel>& list = scene.output.channels;
  return scene.output.exr && std::find(list.begin(), list.end(), channel) != list.end();
}

namespace {

struct Finding {
  bool on;
  std::string reason;
};

// `automatic` is only asked when the scene leaves the decision to the program.
bool decide(EffectPlan& plan, const char* name, Switch wanted, const Finding& automatic) {
  Finding finding = automatic;
  if (wanted == Switch::on) finding = {true, "the scene asks for it"};
  if (wanted == Switch::off)
    finding = {false, automatic.on ? fmt::format("the scene turns it off, although {}", automatic.reason)
                                   : "the scene turns it off"};
  plan.decisions.push_back({name, finding.on, finding.reason});
  return finding.on;
}

std::vector<const Medium*> mediaInUse(const Scene& scene) {
  std::vector<const Medium*> used{&scene.medium(scene.background)};
  for (const Structure& s : scene.structures) used.push_back(&scene.medium(s.medium));
  return used;
}

Finding interfaces(const Scene& scene) {
  const std::vector<const Medium*> used = mediaInUse(scene);
  for (const Medium* m : used)
    if (m->impedance_kg_m2_s != used[0]->impedance_kg_m2_s ||
        m->sound_speed_m_s != used[0]->sound_speed_m_s)
      return {true, fmt::format("{} and {} differ in impedance or speed", used[0]->name, m->name)};
  return {false, "all media have the same impedance and speed, so no interface reflects"};
}

// A membrane bends nothing, so only the media that enclose something count.
Finding bending(const Scene& scene) {
  const Medium& outside = scene.medium(scene.background);
  for (const Structure& s : scene.structures)
    if (!s.membrane && scene.medium(s.medium).sound_speed_m_s != outside.sound_speed_m_s)
      return {true, fmt::format("{} ({} m/s) bends rays from {} ({} m/s)", s.name,
                                scene.medium(s.medium).sound_speed_m_s, outside.name,
                                outside.sound_speed_m_s)};
  return {false, "every structure has the sound speed of its surroundings, so no ray bends"};
}

Finding losses(const Scene& scene) {
  for (const Medium* m : mediaInUse(scene))
    if (m->attenuation_np_per_m > 0) {
      if (wants(scene, Channel::y)) return {true, "channel Y holds received intensities"};
      if (wants(scene, Channel::attenuation)) return {true, "channel attenuation.A is asked for"};
      if (scene.signal.tgc != Tgc::perfect) return {true, "the time gain does not undo it exactly"};
      return {false, "perfect TGC undoes it and no received intensity was asked for"};
    }
  return {false, "no medium attenuates"};
}

Finding scattering(const Scene& scene) {
  const std::vector<const Medium*> used = mediaInUse(scene);
  for (const Medium* m : used)
    if (m->backscatter_per_m_sr > 0) return {true, fmt::format("{} scatters back", m->name)};
  return {false, "no medium scatters back"};
}

}  // namespace

EffectPlan planEffects(const Scene& scene) {
  EffectPlan plan;
  const EffectSwitches& wanted = scene.effects;
  plan.reflection = decide(plan, "reflection", wanted.reflection, interfaces(scene));
  plan.transmission_loss =
      decide(plan, "transmission_loss", wanted.transmission_loss, interfaces(scene));
  plan.refraction = decide(plan, "refraction", wanted.refraction, bending(scene));
  plan.attenuation = decide(plan, "attenuation", wanted.attenuation, losses(scene));
  plan.backscatter = decide(plan, "backscatter", wanted.backscatter, scattering(scene));
  plan.travel_time = decide(plan, "travel_time", wanted.travel_time,
                            {false, "echoes are placed at their path length"});
  return plan;
}

}  // namespace echocine
