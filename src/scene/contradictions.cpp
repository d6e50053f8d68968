#include "scene/contradictions.h"

#include <fmt/format.h>

#include "core/units.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// Rejects keys that contradict several rays per beam.
void refuseOfRays(TomlTable& root, const Scene& scene) {
  const AccuracySettings& a = scene.accuracy;
  const TomlTable accuracy = root.table("accuracy"), signal = root.table("signal");
  const std::string rays = fmt::format("accuracy.rays_per_beam = {}", a.rays_per_beam);
  if (a.tracer == TracerChoice::slice)
    accuracy.fail("tracer", fmt::format("\"slice\" excludes {}, accepted with it: \"auto\" | "
                                        "\"embree\"",
                                        rays));
  if (a.interface_echo == InterfaceEcho::cell)
    accuracy.fail(
        "interface_echo",
        fmt::format("\"cell\" excludes {}, accepted with it: \"auto\" | \"centre\"", rays));
  if (scene.signal.beam_width == BeamWidth::fixed)
    signal.fail("beam_width",
                fmt::format("\"fixed\" excludes {}, whose beam follows aperture and "
                            "focus, accepted with it: \"focused\" | \"profile\" | \"none\"",
                            rays));
  const bool lateral =
      scene.signal.beam_width != BeamWidth::none && scene.effects.beam_width != Switch::off;
  if (!lateral && scene.effects.elevation == Switch::off)
    accuracy.fail(
        "rays_per_beam",
        fmt::format("is {}, but with effects.elevation = \"off\" and {} the beam has no width, "
                    "accepted with them: 1",
                    a.rays_per_beam,
                    scene.effects.beam_width == Switch::off ? "effects.beam_width = \"off\""
                                                            : "signal.beam_width = \"none\""));
}

// Rejects keys that contradict several slices across the plane. Slices from a look are dropped
// instead, as are all slices with several rays per beam, which sample that direction themselves.
void refuseOfSlices(TomlTable& root, const Scene& scene) {
  const AccuracySettings& a = scene.accuracy;
  const TomlTable accuracy = root.table("accuracy");
  const auto refuse = [&](std::string_view other) {
    accuracy.fail("elevation_slices",
                  fmt::format("{} excludes {}, accepted with it: 1", a.elevation_slices, other));
  };
  if (a.tracer == TracerChoice::embree) refuse("accuracy.tracer = \"embree\"");
  if (scene.effects.refraction == Switch::on) refuse("effects.refraction = \"on\"");
  if (scene.effects.elevation == Switch::off) refuse("effects.elevation = \"off\"");
}

// A pulse that speckle can be made of.
void refuseOfSpeckle(TomlTable& root, const Scene& scene) {
  const double pulse_m = scene.signal.pulse_cycles * ScanGeometry(scene.probe).wavelength() / 2;
  if (!(pulse_m > 0))
    root.table("signal").fail("pulse_cycles",
                              "0 excludes speckle.on = true, accepted with it: a number over 0");
  if (scene.probe.max_depth_m > 0 && pulse_m > scene.probe.max_depth_m - scene.probe.min_depth_m)
    root.table("signal").fail(
        "pulse_cycles", fmt::format("makes a pulse of {:.3g} mm, longer than the sampled depth, "
                                    "accepted with speckle.on = true: a shorter one",
                                    millimetresFromMetres(pulse_m)));
}

}  // namespace

void refuseContradictions(TomlTable& root, const Scene& scene) {
  const AccuracySettings& a = scene.accuracy;
  const TomlTable effects = root.table("effects"), accuracy = root.table("accuracy"),
                  output = root.table("output"), acquisition = root.table("acquisition");
  if (scene.acquisition.time_warp == WarpChoice::systole && !scene.motion.keyframe_heart_rate_hz)
    acquisition.fail("time_warp",
                     "\"systole\" needs motion.keyframe_heart_rate_bpm, accepted without it: "
                     "\"auto\" | \"uniform\"");
  if (scene.effects.refraction == Switch::on && a.tracer == TracerChoice::slice)
    effects.fail(
        "refraction",
        "\"on\" excludes accuracy.tracer = \"slice\", accepted with it: \"auto\" | \"off\"");
  if (scene.speckle.on) refuseOfSpeckle(root, scene);
  if (a.rays_per_beam > 1) refuseOfRays(root, scene);
  if (root.table("accuracy").has("elevation_slices") && a.elevation_slices > 1)
    refuseOfSlices(root, scene);
  if (scene.effects.elevation == Switch::on && a.rays_per_beam == 1 && a.elevation_slices == 1)
    effects.fail("elevation",
                 "\"on\" needs accuracy.rays_per_beam or accuracy.elevation_slices over 1, "
                 "accepted with one ray and one slice: \"auto\" | \"off\"");
  if (scene.effects.attenuation == Switch::off && scene.output.channels_given)
    for (const Channel c : scene.output.channels)
      if (c == Channel::y || c == Channel::attenuation || c == Channel::reflection ||
          c == Channel::backscatter)
        output.fail("channels", fmt::format("{} holds attenuation, which effects.attenuation = "
                                            "\"off\" leaves out, accepted with it: "
                                            "unattenuated.Y, medium.id, display.Y",
                                            channelName(c)));
}

}  // namespace echocine
