#include "study/knobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "frame/plan_loop.h"
#include "motion/surfaces/mesh_motion.h"
#include "plan/effect_plan.h"
#include "scene/beam_profile.h"
#include "scene/elevation_slices.h"
#include "scene/scan_geometry.h"
#include "study/knob_builder.h"

namespace echocine {

namespace {

// Our choices. Walls are edges in the picture, so its error falls slowly with finer lines and
// samples: about as the root of their distance, and as their distance.
constexpr std::array<double, 5> kPerBeam{1, 2, 4, 8, 16};
constexpr std::array<std::size_t, kPresets> kOfPreset{0, 2, 3, 4};
constexpr int kRounding = 16;  // lines and samples come in multiples of it
constexpr int kMostLines = 65536, kMostSamples = 65536;  // as the scene reader accepts
constexpr double kMostPolarSamples = 1 << 25;            // half of it, for rounding's sake

int rounded(double count, int most) {
  const double whole = kRounding * std::ceil(std::max(count, 1.0) / kRounding);
  return static_cast<int>(std::min(whole, static_cast<double>(most)));
}

// How many beams lie side by side in the sector at the focus, and half pulses along a line.
struct KnobExtent {
  double beams = 1, pulses = 1;
};

KnobExtent extentOf(const Scene& scene) {
  const Probe& probe = scene.probe;
  Probe two = probe;
  two.lines = 2;
  const double width_m = scene.signal.beam_width == BeamWidth::fixed
                             ? scene.signal.beam_width_m
                             : focusedBeamWidth(probe.focus_m, probe.aperture_m, probe.focus_m,
                                                ScanGeometry(probe).wavelength());
  const double cycles = scene.signal.pulse_cycles > 0 ? scene.signal.pulse_cycles : 2;
  KnobExtent extent{
      lineSpacing(two, probe.focus_m) / width_m,
      (probe.max_depth_m - probe.min_depth_m) / (cycles * ScanGeometry(probe).wavelength() / 2)};
  if (probe.lines < 2) extent.beams = 1 / kPerBeam.back();
  const double finest = kPerBeam.back() * extent.beams * kPerBeam.back() * extent.pulses;
  const double shrink = std::sqrt(std::min(1.0, kMostPolarSamples / finest));
  return {extent.beams * shrink, extent.pulses * shrink};
}

void addLines(const Scene& scene, KnobBuilder& table) {
  if (scene.probe.lines < 2) return table.leaveOut("lines", "the scene has a single line");
  const double beams = extentOf(scene).beams;
  std::vector<int> lines;
  for (const double n : kPerBeam) lines.push_back(rounded(n * beams, kMostLines));
  table.addNumbers("lines", "probe.lines", "scan lines", lines, kOfPreset,
                   [](Scene& s, int n) { s.probe.lines = n; });
}

void addSamples(const Scene& scene, KnobBuilder& table) {
  const double pulses = extentOf(scene).pulses;
  std::vector<int> samples;
  for (const double n : kPerBeam) samples.push_back(rounded(n * pulses, kMostSamples));
  table.addNumbers("samples", "probe.samples", "samples of a line", samples, kOfPreset,
                   [](Scene& s, int n) { s.probe.samples = n; });
}

void addRefraction(const Scene& scene, const MeshMotion& motion, KnobBuilder& table) {
  if (scene.effects.refraction != Switch::automatic)
    return table.leaveOut("refraction", "effects.refraction is not automatic");
  if (scene.accuracy.tracer == TracerChoice::slice)
    return table.leaveOut("refraction", "accuracy.tracer = \"slice\" bends no ray");
  if (!planEffects(scene).refraction)
    return table.leaveOut("refraction", planEffects(scene).decision(Effect::refraction).reason);
  const KnobValue off{"off", [](Scene& s) { s.effects.refraction = Switch::off; }};
  const KnobValue on{"on", [](Scene& s) { s.effects.refraction = Switch::on; }};
  // Where the plan leaves refraction out it moves echoes by less than the picture shows, while
  // links between bent lines know a little less of the walls than contours do; so the reference
  // does what the plan says.
  // A tolerance over the shift that the plan found is off, one under it is on.
  const EffectPlan plan = planLoop(scene, motion).effects;
  const bool bends = plan.refraction;
  Knob knob{
      "refraction",
      "effects.refraction",
      "rays bend where sound speeds differ; the plan of the scene as written is the reference: " +
          plan.decision(Effect::refraction).reason,
      {bends ? off : on, bends ? on : off},
      {1, 1, 1, 1}};
  if (bends) knob.of_preset[0] = 0;
  table.add(std::move(knob));
}

// One ray takes the paper's average over the beam; several trace it. That is another model of the
// beam, so the scene's own choice is the reference.
void addRays(const Scene& scene, KnobBuilder& table) {
  const int written = scene.accuracy.rays_per_beam;
  if (scene.accuracy.tracer == TracerChoice::slice ||
      scene.accuracy.interface_echo == InterfaceEcho::cell)
    return table.leaveOut("rays", "several rays go through the hierarchy, at each ray's own echo");
  if (scene.signal.beam_width == BeamWidth::fixed)
    return table.leaveOut("rays",
                          "signal.beam_width = \"fixed\" has no aperture to draw rays over");
  Scene several_rays = scene;
  several_rays.accuracy.rays_per_beam = 2;
  if (planEffects(several_rays).rays_per_beam == 1)
    return table.leaveOut("rays", "there is nothing to spread several rays over");
  std::vector<int> counts{8, 32, 1};
  if (written > 1) counts = {1, std::max(2, written / 16), std::max(2, written / 4), written};
  const std::size_t last = counts.size() - 1;
  const bool several = written > 1;
  table.addNumbers("rays", "accuracy.rays_per_beam",
                   "1: the average over the beam; several: traced over its profile", counts,
                   {several ? 0 : last, several ? last - 1 : last, last, last},
                   [](Scene& s, int n) { s.accuracy.rays_per_beam = n; });
}

// The beam across the plane, of one ray per beam. Another model of the beam, as several rays are.
void addSlices(const Scene& scene, KnobBuilder& table) {
  const int written = scene.accuracy.elevation_slices;
  Scene several = scene;
  several.accuracy.elevation_slices = kMostElevationSlices;
  if (scene.accuracy.tracer == TracerChoice::embree || scene.effects.refraction == Switch::on)
    return table.leaveOut("slices", "only the plane slice has several slices");
  if (planEffects(several).elevation_slices == 1)
    return table.leaveOut("slices", planEffects(several).decision(Effect::elevation).reason);
  std::vector<int> counts{3, 5, 1};
  if (written == 3) counts = {1, 5, 3};
  if (written == 5) counts = {1, 3, 5};
  const std::size_t last = counts.size() - 1, first = written > 1 ? 0 : last;
  table.addNumbers(
      "slices", "accuracy.elevation_slices", "1: the imaging plane; several: the beam across it",
      counts, {first, last, last, last}, [](Scene& s, int n) { s.accuracy.elevation_slices = n; });
}

void addEchoes(const Scene& scene, KnobBuilder& table) {
  if (scene.probe.lines < 2) return table.leaveOut("echoes", "the scene has a single line");
  const auto value = [](const char* name, InterfaceEcho echo) {
    return KnobValue{name, [echo](Scene& s) { s.accuracy.interface_echo = echo; }};
  };
  // "auto" is over cells wherever a beam has one ray.
  table.add({"echoes",
             "accuracy.interface_echo",
             "interface echoes at the lines, or over the beam's cell where it has one ray",
             {value("centre", InterfaceEcho::centre), value("auto", InterfaceEcho::automatic)},
             {0, 1, 1, 1}});
}

// A knob of what the files keep of the intensities. That is the scene's say: its own value stands
// in every preset, and the error is that of what is read back.
template <typename Kind>
void addStorage(const Scene& scene, Knob knob, Kind OutputSettings::*setting,
                const std::vector<std::pair<const char*, Kind>>& kinds, KnobBuilder& table) {
  if (!scene.output.exr) return table.leaveOut(knob.name, "output.exr = false stores nothing");
  for (const auto& [label, kind] : kinds) {
    if (kind == scene.output.*setting) knob.of_preset.fill(knob.values.size());
    knob.values.push_back({label, [=, kind = kind](Scene& s) { s.output.*setting = kind; }});
  }
  table.add(std::move(knob));
}

}  // namespace

KnobTable knobsOf(const Scene& scene) {
  std::size_t triangles = 0;
  const MeshMotion motion(scene);
  for (const SurfaceTopology& surface : motion.surfaces()) triangles += surface.triangles.size();
  KnobBuilder table;
  addLines(scene, table);
  addSamples(scene, table);
  addMotionKnobs(scene, triangles, table);
  addRefraction(scene, motion, table);
  addRays(scene, table);
  addSlices(scene, table);
  addEchoes(scene, table);
  addModelKnobs(scene, table);
  addStorage<ExrPixel>(
      scene, {"exr_pixel", "output.exr_pixel", "stored intensities, 16 or 32 bits", {}, {}},
      &OutputSettings::exr_pixel, {{"half", ExrPixel::half}, {"float", ExrPixel::whole}}, table);
  addStorage<ExrCompression>(
      scene,
      {"exr_compression", "output.exr_compression", "stored intensities, pxr24 of 24 bits", {}, {}},
      &OutputSettings::exr_compression,
      {{"pxr24", ExrCompression::pxr24},
       {"piz", ExrCompression::piz},
       {"zips", ExrCompression::zips},
       {"zip", ExrCompression::zip},
       {"rle", ExrCompression::rle},
       {"none", ExrCompression::none}},
      table);
  return std::move(table.table);
}

std::vector<std::string> knobNames() {
  return {"lines",         "samples",        "subdivision", "normals", "keyframes",
          "interpolation", "refraction",     "rays",        "slices",  "echoes",
          "snell_angles",  "reflection_cap", "thin_layers", "tgc",     "rolling_lines",
          "exr_pixel",     "exr_compression"};
}

Setting presetSetting(const KnobTable& table, Preset preset) {
  Setting setting;
  for (const Knob& knob : table.knobs)
    setting.push_back(knob.of_preset[static_cast<std::size_t>(preset)]);
  return setting;
}

Scene sceneWith(const Scene& scene, const KnobTable& table, const Setting& setting) {
  Scene changed = scene;
  for (std::size_t k = 0; k < table.knobs.size(); ++k)
    table.knobs[k].values[setting[k]].apply(changed);
  return changed;
}

std::string settingText(const KnobTable& table, const Setting& setting) {
  std::string text;
  for (std::size_t k = 0; k < table.knobs.size(); ++k)
    text += fmt::format("{}{} = {}", k ? ", " : "", table.knobs[k].key,
                        table.knobs[k].values[setting[k]].label);
  return text;
}

}  // namespace echocine
