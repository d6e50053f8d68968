#pragma once
// The effects: their names, and which of them a scene can switch.

#include "scene/named.h"

namespace echocine {

enum class Switch { automatic, on, off };

// Everything that a loop may compute or omit. effect_plan.cpp describes each, with the reasons to
// omit it.
enum class Effect {
  reflection,
  lobe,
  transmission_loss,
  refraction,
  snell_angles,
  reflection_cap,
  thin_layers,
  attenuation,
  backscatter,
  spread,
  beam_width,
  elevation,
  travel_time,
  trabeculae,
  speckle,
  heterogeneity,
  anisotropy,
  coherent_echoes,
  dropout,
  acoustic_window,
  haze,
  reverberation,
  clutter,
  noise,
  persistence,
  rolling,
  tgc,
  log_compression,
  labels,
  truth_labels,
  truth_contours,
  truth_tracks,
  truth_function,
  channel  // of the intensity stack, one decision per channel
};

// Switches of the scene's [effects], automatic by default.
struct EffectSwitches {
  Switch reflection{};
  Switch lobe{};
  Switch transmission_loss{};
  Switch refraction{};
  Switch snell_angles{};
  Switch reflection_cap{};
  Switch thin_layers{};
  Switch attenuation{};
  Switch backscatter{};
  Switch spread{};
  Switch beam_width{};
  Switch elevation{};
  Switch travel_time{};
};

// The effects that a scene can switch, with descriptions; the keys of [effects] follow these rows.
struct EffectSwitch {
  Effect effect;
  const char* key;
  const char* meaning;
  Switch EffectSwitches::*wanted;
};
inline constexpr EffectSwitch kEffectSwitches[] = {
    {Effect::reflection, "reflection", "echoes of interfaces", &EffectSwitches::reflection},
    {Effect::lobe, "lobe", "cos^n of the non-specular return", &EffectSwitches::lobe},
    {Effect::transmission_loss, "transmission_loss", "(1-R)^2 at each interface passed",
     &EffectSwitches::transmission_loss},
    {Effect::refraction, "refraction", "bent rays", &EffectSwitches::refraction},
    {Effect::snell_angles, "snell_angles",
     "straight rays meet interfaces at the angles of bent ones", &EffectSwitches::snell_angles},
    {Effect::reflection_cap, "reflection_cap",
     "W is at most R at normal incidence; off: W is R at every angle",
     &EffectSwitches::reflection_cap},
    {Effect::thin_layers, "thin_layers", "interfaces less than half a pulse apart echo coherently",
     &EffectSwitches::thin_layers},
    {Effect::attenuation, "attenuation", "exp(-4 alpha l)", &EffectSwitches::attenuation},
    {Effect::backscatter, "backscatter", "Eqs. 4-7", &EffectSwitches::backscatter},
    {Effect::spread, "spread", "1/l^2 of the backscattered part", &EffectSwitches::spread},
    {Effect::beam_width, "beam_width",
     "average over the beam, by its rays where there are several, and over the pulse",
     &EffectSwitches::beam_width},
    {Effect::elevation, "elevation", "rays out of the imaging plane", &EffectSwitches::elevation},
    {Effect::travel_time, "travel_time",
     "echoes at 1540 m/s t/2 instead of their path length; only when on",
     &EffectSwitches::travel_time}};

template <>
struct NamesOf<Effect> {
  static constexpr Named<Effect> kAll[] = {{Effect::reflection, "reflection"},
                                           {Effect::lobe, "lobe"},
                                           {Effect::transmission_loss, "transmission_loss"},
                                           {Effect::refraction, "refraction"},
                                           {Effect::snell_angles, "snell_angles"},
                                           {Effect::reflection_cap, "reflection_cap"},
                                           {Effect::thin_layers, "thin_layers"},
                                           {Effect::attenuation, "attenuation"},
                                           {Effect::backscatter, "backscatter"},
                                           {Effect::spread, "spread"},
                                           {Effect::beam_width, "beam_width"},
                                           {Effect::elevation, "elevation"},
                                           {Effect::travel_time, "travel_time"},
                                           {Effect::trabeculae, "trabeculae"},
                                           {Effect::speckle, "speckle"},
                                           {Effect::heterogeneity, "heterogeneity"},
                                           {Effect::anisotropy, "anisotropy"},
                                           {Effect::coherent_echoes, "coherent_echoes"},
                                           {Effect::dropout, "dropout"},
                                           {Effect::acoustic_window, "acoustic_window"},
                                           {Effect::haze, "haze"},
                                           {Effect::reverberation, "reverberation"},
                                           {Effect::clutter, "clutter"},
                                           {Effect::noise, "noise"},
                                           {Effect::persistence, "persistence"},
                                           {Effect::rolling, "rolling"},
                                           {Effect::tgc, "tgc"},
                                           {Effect::log_compression, "log_compression"},
                                           {Effect::labels, "labels"},
                                           {Effect::truth_labels, "truth labels"},
                                           {Effect::truth_contours, "truth contours"},
                                           {Effect::truth_tracks, "truth tracks"},
                                           {Effect::truth_function, "truth function"},
                                           {Effect::channel, "channel"}};
};

}  // namespace echocine
