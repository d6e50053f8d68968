#include "plan/beam_findings.h"

#include <fmt/format.h>

#include "core/units.h"
#include "plan/effect_plan.h"
#include "scene/scan_geometry.h"

namespace echocine {

bool severalRays(const Scene& scene) {
  return scene.accuracy.rays_per_beam > 1 &&
         (wantsIntensity(scene, true) || wantsIntensity(scene, false));
}

bool severalSlices(const Scene& scene) {
  return scene.accuracy.elevation_slices > 1 && scene.accuracy.rays_per_beam == 1 &&
         (wantsIntensity(scene, true) || wantsIntensity(scene, false));
}

bool lateralRays(const Scene& scene) {
  return severalRays(scene) && (scene.signal.beam_width == BeamWidth::focused ||
                                scene.signal.beam_width == BeamWidth::profile);
}

Finding findBeamWidth(const Scene& scene) {
  if (lateralRays(scene))
    return {true,
            fmt::format("{} rays over the beam of {:g} mm focused at {:g} mm; the picture's "
                        "average is over the pulse alone",
                        scene.accuracy.rays_per_beam, millimetresFromMetres(scene.probe.aperture_m),
                        millimetresFromMetres(scene.probe.focus_m))};
  if (!wantsPicture(scene)) return {false, "no picture is requested"};
  const bool lateral = scene.signal.beam_width != BeamWidth::none && scene.probe.lines > 1;
  const double pulse_m = scene.signal.pulse_cycles * ScanGeometry(scene.probe).wavelength() / 2;
  if (lateral)
    return {true, "average over the beam at each depth (signal.beam_width) and over the pulse"};
  if (pulse_m > scene.probe.sampleSpacing())
    return {true, "average over the pulse, longer than a sample"};
  return {false, "beam and pulse are no wider than a sample"};
}

Finding findElevation(const Scene& scene) {
  const bool rays = severalRays(scene), slices = severalSlices(scene);
  if (scene.accuracy.rays_per_beam == 1 && scene.accuracy.elevation_slices == 1)
    return {false, "one ray per beam stays in the imaging plane"};
  if (!rays && !slices) return {false, "no requested output contains intensities"};
  return {true, fmt::format("{} over a lens of {:g} mm focused at {:g} mm",
                            rays ? fmt::format("{} rays", scene.accuracy.rays_per_beam)
                                 : fmt::format("{} slices", scene.accuracy.elevation_slices),
                            millimetresFromMetres(scene.probe.elevation_aperture_m),
                            millimetresFromMetres(scene.probe.elevation_focus_m))};
}

}  // namespace echocine
