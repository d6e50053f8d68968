#pragma once
// Scenes built in memory, without files, for the trace and signal stages.

#include <numbers>

#include "core/units.h"
#include "plan/effect_plan.h"
#include "trace/line_walker.h"
#include "trace/trace_frame.h"

namespace echocine::support {

inline Medium medium(const std::string& name, double density_kg_m3, double c_m_s,
                     double alpha_np_per_m = 0, double eta_b_per_m_sr = 0) {
  return {name, density_kg_m3 * c_m_s, c_m_s, alpha_np_per_m, eta_b_per_m_sr};
}

// A phased probe at the origin; media[0] is the background.
inline Scene plainScene(const std::vector<Medium>& media) {
  Scene scene;
  scene.media = media;
  scene.probe.first_angle_rad = radiansFromDegrees(-37.5);
  scene.probe.last_angle_rad = radiansFromDegrees(37.5);
  scene.probe.max_depth_m = 0.16;
  scene.probe.frequency_hz = 2.5e6;
  scene.probe.aperture_m = 0.02;
  scene.probe.focus_m = 0.08;
  scene.probe.lines = 1;
  scene.probe.samples = 160;
  return scene;
}

// As the reader makes a radial probe.
inline void lookAllRound(double face_radius_m, Probe& probe) {
  probe.kind = ProbeKind::radial;
  probe.first_angle_rad = -std::numbers::pi;
  probe.last_angle_rad = std::numbers::pi;
  probe.face_radius_m = face_radius_m;
}

inline void addStructure(Scene& scene, std::size_t medium_index, int priority,
                         bool membrane = false) {
  Structure s;
  s.name = "structure_" + std::to_string(scene.structures.size());
  s.medium = MediumId(medium_index);
  s.priority = priority;
  s.membrane = membrane;
  scene.structures.push_back(s);
}

// A crossing of a ray along +z whose incidence has the given cosine.
inline Crossing crossingAt(double distance_m, std::uint32_t surface, bool entering,
                           double cos_i = 1) {
  const double sin_i = std::sqrt(1 - cos_i * cos_i);
  return {distance_m, entering ? Vec3d{sin_i, 0, -cos_i} : Vec3d{sin_i, 0, cos_i},
          SurfaceId{surface}, 0, entering};
}

inline const Ray kDepthwards{{0, 0, 0}, {0, 0, 1}};

// A straight walk along +z over given crossings.
inline LineTrace walkStraight(const TraceSettings& settings, const std::vector<Crossing>& crossings,
                              const InsideSet& inside = {}) {
  LineTrace trace;
  LineWalker walker(settings, kDepthwards, inside, trace);
  walker.advance({crossings, inside});
  return trace;
}

inline TraceSettings straightSettings(const Scene& scene) {
  TraceSettings settings(scene, planEffects(scene));
  settings.refraction = false;
  return settings;
}

// The paper's letter: every interface by itself, a mirror as it is, angles of the straight ray.
inline TraceSettings letterSettings(const Scene& scene) {
  TraceSettings settings = straightSettings(scene);
  settings.snell_angles = settings.reflection_cap = settings.thin_layers = false;
  return settings;
}

inline Sampling samplingOf(const Probe& probe) {
  return {probe.min_depth_m, probe.sampleSpacing(), probe.samples};
}

inline std::vector<float> intensityOf(const LineTrace& line, const Sampling& sampling,
                                      const IntensityTerms& parts = {}) {
  std::vector<float> values(static_cast<std::size_t>(sampling.samples), -1.0f);
  sampleIntensity(line, sampling, parts, values);
  return values;
}

}  // namespace echocine::support
