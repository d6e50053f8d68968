// The knobs of what the model decides where the paper leaves it open. Effects and time gain are no
// matter of accuracy: the scene's own stands in every preset, and the error is how much the
// decision changes.

#include "plan/effect_plan.h"
#include "scene/names.h"
#include "study/knob_builder.h"

namespace echocine {

namespace {

struct ModelSwitch {
  const char *name, *key, *meaning;
  Effect effect;
  Switch EffectSwitches::*wanted;
};

constexpr ModelSwitch kSwitches[] = {
    {"snell_angles", "effects.snell_angles", "straight rays meet interfaces at Snell's angles",
     Effect::snell_angles, &EffectSwitches::snell_angles},
    {"reflection_cap", "effects.reflection_cap", "no wall reflects more than at normal incidence",
     Effect::reflection_cap, &EffectSwitches::reflection_cap},
    {"thin_layers", "effects.thin_layers",
     "interfaces less than half a pulse apart echo coherently", Effect::thin_layers,
     &EffectSwitches::thin_layers}};

void addSwitch(const Scene& scene, const ModelSwitch& of, KnobBuilder& table) {
  if (scene.effects.*of.wanted != Switch::automatic)
    return table.leaveOut(of.name, std::string(of.key) + " is not automatic");
  const EffectPlan plan = planEffects(scene);
  if (!plan.decision(of.effect).on) return table.leaveOut(of.name, plan.decision(of.effect).reason);
  const auto value = [&](const char* label, Switch wanted) {
    return KnobValue{label, [key = of.wanted, wanted](Scene& s) { s.effects.*key = wanted; }};
  };
  table.add({of.name,
             of.key,
             of.meaning,
             {value("off", Switch::off), value("auto", Switch::automatic)},
             {1, 1, 1, 1}});
}

void addTimeGain(const Scene& scene, KnobBuilder& table) {
  const Tgc written = scene.signal.tgc;
  if (written != Tgc::perfect && written != Tgc::mean)
    return table.leaveOut("tgc", "signal.tgc is neither \"perfect\" nor \"mean\"");
  const Tgc other = written == Tgc::mean ? Tgc::perfect : Tgc::mean;
  const auto value = [](Tgc tgc) {
    return KnobValue{std::string(nameOf(tgc)), [tgc](Scene& s) { s.signal.tgc = tgc; }};
  };
  table.add({"tgc",
             "signal.tgc",
             "each sample's own attenuation undone, or the mean over all lines",
             {value(other), value(written)},
             {1, 1, 1, 1}});
}

// The reference's groups of eight move by a 32nd of a frame's interval among 256 lines.
void addRolling(const Scene& scene, KnobBuilder& table) {
  if (!scene.acquisition.rolling)
    return table.leaveOut("rolling_lines", "acquisition.rolling = false: all lines at one instant");
  table.addNumbers("rolling_lines", "accuracy.rolling_lines",
                   "neighbouring lines that share the instant of their middle",
                   {128, 64, 32, 16, 8}, {1, 2, 3, 4},
                   [](Scene& s, int n) { s.accuracy.rolling_lines = n; });
}

}  // namespace

void addModelKnobs(const Scene& scene, KnobBuilder& table) {
  for (const ModelSwitch& s : kSwitches) addSwitch(scene, s, table);
  addTimeGain(scene, table);
  addRolling(scene, table);
}

}  // namespace echocine
