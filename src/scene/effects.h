#pragma once
// The effects: the one table of their names, switches and costs, and the settings of artefacts.

#include <array>
#include <cstddef>
#include <iterator>

#include "core/stage.h"
#include "scene/named.h"

namespace echocine {

enum class Switch { automatic, on, off };

// Everything that a loop may compute or omit. The plan room describes each, with the reasons to
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
  leaflets,
  chordae,
  annulus,
  speckle,
  heterogeneity,
  anisotropy,
  coherent_echoes,
  dropout,
  acoustic_window,
  shading,
  lung,
  haze,
  reverberation,
  clutter,
  noise,
  persistence,
  rolling,
  harmonic,
  downshift,
  receive_aperture,
  tgc,
  log_compression,
  edge_enhancement,
  grey_map,
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

// Artefacts of a scanner, independent of each other. Levels are intensities.
struct ArtefactSettings {
  bool dropout = false;            // lines at the sector's edges lose contact
  double dropout_db = 12;          // on the outermost lines
  bool acoustic_window = false;    // ribs shade part of the aperture
  double window_width_m = 24e-3;   // between them
  double window_offset_m = 0;      // of its middle, along the lateral axis
  double window_depth_m = 12e-3;   // of the ribs, from the probe's face
  double window_shadow_db = 30;    // loss in the full shadow, both ways
  bool shading = false;            // the chest wall transmits unevenly
  double shading_db = 3;           // standard deviation of one passage
  double shading_grain_m = 10e-3;  // size of its patches
  double shading_depth_m = 20e-3;  // from the probe's face
  int shading_seed = 1;
  bool lung = false;                            // reverberations beyond air-filled lung's surface
  double lung_db = -3;                          // relative to the tissue in front of it
  double lung_length_m = 20e-3;                 // where they have fallen to 1/e
  bool haze = false;                            // aberration, multiple scattering: across the lines
  double haze_db = -24;                         // relative to all its sources
  double haze_width_rad = 0.12217304763960307;  // where it has fallen to 1/e
  bool reverberation = false;                   // a tail behind every echo
  double reverberation_db = -27;                // relative to the echo
  double reverberation_length_m = 6e-3;         // where it has fallen to 1/e
  bool clutter = false;                         // of the near field
  double clutter_db = -28;                      // relative to white, at the face
  double clutter_length_m = 6e-3;               // where it has fallen to 1/e
  double clutter_width_rad = 0.15707963267948966;  // of its speckle, full width at half maximum
  double clutter_parasternal_db = 0;  // added where the beam is across the left ventricle's axis
  double clutter_time_s = 0;          // of its renewal; 0: static
  int clutter_seed = 1;
  bool noise = false;     // of the receiver, before the time gain
  double noise_db = -55;  // relative to white, at the depth of the largest gain
  int noise_seed = 1;
  double persistence = 0;  // weight of each frame relative to the next one; 0: none
};

// Relative time of an effect: per crossing, ray, backscattering sample and attenuated sample, and
// per frame. Our choice, weighed by the operations of each, not timed. All 0: not measured.
struct EffectCost {
  double crossing = 0, ray = 0, scattered = 0, attenuated = 0, fixed = 0;
};

// A row for each effect. One that the scene can switch also has the meaning of its key in
// [effects], which is its name.
struct EffectRow {
  Effect effect;
  const char* name;
  Stage stage;        // in which its time is spent
  EffectCost cost{};  // relative to others of its stage
  const char* meaning = nullptr;
  Switch EffectSwitches::*wanted = nullptr;
};

// clang-format off
inline constexpr EffectRow kEffects[] = {
    {Effect::reflection, "reflection", Stage::trace, {.crossing = 20}, "echoes of interfaces", &EffectSwitches::reflection},
    {Effect::lobe, "lobe", Stage::trace, {.crossing = 5}, "cos^n of the non-specular return", &EffectSwitches::lobe},
    {Effect::transmission_loss, "transmission_loss", Stage::trace, {.crossing = 10}, "(1-R)^2 at each interface passed", &EffectSwitches::transmission_loss},
    {Effect::refraction, "refraction", Stage::trace, {.ray = 200}, "bent rays", &EffectSwitches::refraction},
    {Effect::snell_angles, "snell_angles", Stage::trace, {}, "straight rays use the angles of incidence of bent rays", &EffectSwitches::snell_angles},
    {Effect::reflection_cap, "reflection_cap", Stage::trace, {}, "W is at most R at normal incidence; off: W is R at every angle", &EffectSwitches::reflection_cap},
    {Effect::thin_layers, "thin_layers", Stage::trace, {}, "interfaces less than half a pulse apart echo coherently", &EffectSwitches::thin_layers},
    {Effect::attenuation, "attenuation", Stage::trace, {.attenuated = 0.5}, "exp(-4 alpha l)", &EffectSwitches::attenuation},
    {Effect::backscatter, "backscatter", Stage::trace, {.scattered = 0.3}, "Eqs. 4-7", &EffectSwitches::backscatter},
    {Effect::spread, "spread", Stage::trace, {.scattered = 0.3}, "1/l^2 of the backscattered part", &EffectSwitches::spread},
    {Effect::beam_width, "beam_width", Stage::signal, {.fixed = 0.8}, "average over beam and pulse; with several rays per beam, the rays average over the beam", &EffectSwitches::beam_width},
    {Effect::elevation, "elevation", Stage::trace, {.ray = 20}, "rays out of the imaging plane", &EffectSwitches::elevation},
    {Effect::travel_time, "travel_time", Stage::trace, {.crossing = 2}, "echoes are placed at 1540 m/s t/2 instead of their path length; only when on", &EffectSwitches::travel_time},
    {Effect::trabeculae, "trabeculae", Stage::geometry, {.fixed = 1}},
    {Effect::leaflets, "leaflets", Stage::geometry, {.fixed = 0.3}},
    {Effect::chordae, "chordae", Stage::trace, {.fixed = 0.01}},
    {Effect::annulus, "annulus", Stage::trace, {.fixed = 0.02}},
    {Effect::speckle, "speckle", Stage::speckle, {.fixed = 1}},
    {Effect::heterogeneity, "heterogeneity", Stage::speckle, {.fixed = 0.01}},
    {Effect::anisotropy, "anisotropy", Stage::speckle, {.fixed = 0.01}},
    {Effect::coherent_echoes, "coherent_echoes", Stage::speckle, {.fixed = 0.1}},
    {Effect::dropout, "dropout", Stage::signal, {.fixed = 0.05}},
    {Effect::acoustic_window, "acoustic_window", Stage::signal, {.fixed = 0.05}},
    {Effect::shading, "shading", Stage::signal, {.fixed = 0.05}},
    {Effect::lung, "lung", Stage::signal, {.fixed = 0.05}},
    {Effect::haze, "haze", Stage::signal, {.fixed = 0.3}},
    {Effect::reverberation, "reverberation", Stage::signal, {.fixed = 0.2}},
    {Effect::clutter, "clutter", Stage::signal, {.fixed = 0.05}},
    {Effect::noise, "noise", Stage::signal, {.fixed = 0.15}},
    {Effect::persistence, "persistence", Stage::signal},
    {Effect::rolling, "rolling", Stage::motion},
    {Effect::harmonic, "harmonic", Stage::signal, {.fixed = 0.02}},
    {Effect::downshift, "downshift", Stage::signal},
    {Effect::receive_aperture, "receive_aperture", Stage::speckle, {.fixed = 0.05}},
    {Effect::tgc, "tgc", Stage::signal, {.fixed = 0.05}},
    {Effect::log_compression, "log_compression", Stage::signal, {.fixed = 0.2}},
    {Effect::edge_enhancement, "edge_enhancement", Stage::signal, {.fixed = 0.1}},
    {Effect::grey_map, "grey_map", Stage::signal},
    {Effect::labels, "labels", Stage::trace, {.scattered = 0.1}},
    {Effect::truth_labels, "truth labels", Stage::truth},
    {Effect::truth_contours, "truth contours", Stage::truth},
    {Effect::truth_tracks, "truth tracks", Stage::truth},
    {Effect::truth_function, "truth function", Stage::truth},
    {Effect::channel, "channel", Stage::exr, {.fixed = 1}}};
// clang-format on

// The rows of effects that a scene can switch.
inline constexpr auto kEffectSwitches = [] {
  constexpr std::size_t kCount = [] {
    std::size_t count = 0;
    for (const EffectRow& row : kEffects) count += row.wanted != nullptr ? 1 : 0;
    return count;
  }();
  std::array<EffectRow, kCount> rows{};
  std::size_t next = 0;
  for (const EffectRow& row : kEffects)
    if (row.wanted != nullptr) rows[next++] = row;
  return rows;
}();

template <>
struct NamesOf<Effect> {
  static constexpr auto kAll = [] {
    std::array<Named<Effect>, std::size(kEffects)> names{};
    for (std::size_t i = 0; i < names.size(); ++i)
      names[i] = {kEffects[i].effect, kEffects[i].name};
    return names;
  }();
};

}  // namespace echocine
