#pragma once
// The effects that a loop needs, decided once before its first frame, each with its reason.

#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// Start of the warning about a loop of black pictures.
inline constexpr std::string_view kNothingSeen = "nothing can be seen";

struct EffectDecision {
  Effect effect{};
  bool on = false;
  std::string reason;
  Channel channel{};  // of Effect::channel

  std::string name() const;  // "refraction", "channel Y"
};

struct EffectPlan {
  bool reflection = true;
  bool lobe = true;
  bool transmission_loss = true;
  bool refraction = true;
  bool snell_angles = true;
  bool reflection_cap = true;
  bool thin_layers = true;
  bool attenuation = true;  // the exponent A is computed
  bool backscatter = true;
  bool spread = true;
  bool beam_width = true;
  bool travel_time = false;
  bool trabeculae = false;  // relief of the ventricles' inner surfaces
  bool leaflets = false;    // mitral and tricuspid ones have thickness
  bool chordae = false;     // of the mitral valve
  bool annulus = false;     // fibrous rings of the valves
  bool speckle = false;
  bool heterogeneity = false, anisotropy = false;  // of the scatterers
  bool coherent_echoes = false;                    // interfaces keep part of their phase
  bool dropout = false, acoustic_window = false, shading = false, lung = false;
  bool haze = false, reverberation = false;
  bool harmonic = false, downshift = false, receive_aperture = false;  // of the sampled beam
  bool edge_enhancement = false;
  bool clutter = false, noise = false, persistence = false;
  double clutter_window_db = 0;  // added to the clutter's level: by the acoustic window
  bool averaged = false;  // clutter and noise add their mean power; planned by src/study alone
  bool rolling = false;   // groups of lines have their own instants
  int rays_per_beam = 1;  // that are traced
  bool lateral_rays = false, elevation = false;  // dimensions sampled by several rays
  int elevation_slices = 1;                      // slices that represent the beam across the plane
  // For signal.tgc = "mean": the loop's mean attenuation factor at the depth of each sample, 0..1.
  std::vector<double> mean_loss;
  bool contrast = true;  // do the media in use differ?
  std::vector<EffectDecision> decisions;

  // Precondition: not Effect::channel.
  const EffectDecision& decision(Effect effect) const;
  EffectDecision& decision(Effect effect);

  // True if the picture can show anything. A single medium shows its speckle.
  bool shows() const { return contrast || speckle; }
};

// Decides from the scene file alone. Refraction stays on if any ray could bend; by how much depends
// on the meshes.
EffectPlan planEffects(const Scene& scene);

// Does the scene request the channel?
bool wants(const Scene& scene, Channel channel);

// Does a requested output contain intensities of interfaces (reflected), or of tissue?
bool wantsIntensity(const Scene& scene, bool reflected);

// Is a picture needed (cine, PNG or channel display.Y)?
bool wantsPicture(const Scene& scene);

}  // namespace echocine
