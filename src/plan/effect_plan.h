#pragma once
// Which effects a loop needs, decided once before its first frame, each with its reason.

#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// How a warning begins of a loop whose pictures stay black.
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
  bool trabeculae = false;  // the ventricles' inner surfaces have a relief
  bool speckle = false;
  bool heterogeneity = false, anisotropy = false;  // of the scatterers
  bool coherent_echoes = false;                    // interfaces keep part of their phase
  bool dropout = false, acoustic_window = false, haze = false, reverberation = false;
  bool clutter = false, noise = false, persistence = false;
  bool rolling = false;                          // groups of lines have instants of their own
  int rays_per_beam = 1;                         // that are traced
  bool lateral_rays = false, elevation = false;  // what several rays are spread over
  int elevation_slices = 1;                      // that stand for the beam across the plane
  // Of signal.tgc = "mean": what the loop's mean attenuation takes at each sample's depth, 0..1.
  std::vector<double> mean_loss;
  bool contrast = true;  // the media in use differ at all
  std::vector<EffectDecision> decisions;

  // Precondition: not Effect::channel.
  const EffectDecision& decision(Effect effect) const;
  EffectDecision& decision(Effect effect);

  // Can a picture show anything? One medium alone shows its speckle.
  bool shows() const { return contrast || speckle; }
};

// What the scene file alone decides. Refraction stays on here where any ray could bend; how far
// rays do bend takes the meshes.
EffectPlan planEffects(const Scene& scene);

// Is the channel among those that the scene asks for?
bool wants(const Scene& scene, Channel channel);

// Does a requested output hold intensities of interfaces, or else of tissue?
bool wantsIntensity(const Scene& scene, bool reflected);

// Is there a picture to make (cine, PNG or channel display.Y)?
bool wantsPicture(const Scene& scene);

}  // namespace echocine
