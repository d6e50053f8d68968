#pragma once
// The scene as the tracer sees it: plain numbers, looked up by surface, decided once per loop.

#include <vector>

#include "plan/effect_plan.h"
#include "scene/scene.h"

namespace echocine {

struct SurfaceTraits {
  MediumId medium{};
  int priority = 0;
  bool membrane = false;
  double gain = 1, exponent = 2;  // of the non-specular lobe
  double coherent_part = 0;       // of its echoes: K / (1 + K)
};

// Echoes of interfaces at the lines; or integrated over the beams' cells, by what the plane slice
// knows of the contours, or by links between the crossings of neighbouring lines.
enum class EchoCells { none, contours, links };

struct TraceSettings {
  TraceSettings(const Scene& scene, const EffectPlan& plan, EchoCells cells = EchoCells::none);

  std::vector<Medium> media;
  std::vector<SurfaceTraits> surfaces;  // by SurfaceId
  MediumId background{};
  double unit_volume_m3 = 0;
  double max_depth_m = 0;
  // Crossings closer than this are one interface: a ten-thousandth of a wavelength. A layer of
  // thickness h reflects as (k h)^2, so thinner ones send nothing back; coincident walls come out
  // as a single interface.
  double thin_layer_m = 0;
  double face_m = 0;  // nearer than this to the transducer's face a wall is in it
  double frequency_hz = 0;
  double wavelength_m = 0;  // the scanner's
  double pulse_cycles = 0;  // N; the pulse's half length is N wavelengths / 2
  bool reflection = true, transmission_loss = true, refraction = true, attenuation = true,
       backscatter = true, travel_time = false;
  bool snell_angles = true;    // straight rays carry Snell's direction for angles of incidence
  bool reflection_cap = true;  // W is at most R at normal incidence
  bool thin_layers = true;     // interfaces closer than the pulse send back one coherent echo
  EchoCells cells = EchoCells::none;
  bool coherent_echoes = false;  // some structure's echoes have a coherent part, and it is wanted
  bool note_hits = false;        // keep what the walk judged of each crossing; contours need it
  // A total reflection ends no line: it goes on straight, as in a thin layer. For what stands in
  // the shadow behind it.
  bool beyond_mirrors = false;
};

}  // namespace echocine
