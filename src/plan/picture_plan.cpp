#include "plan/picture_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/units.h"
#include "plan/media_in_use.h"
#include "scene/grey_curve.h"
#include "scene/role.h"

namespace echocine {

namespace {

// Decides an effect that changes only the picture.
bool decidePicture(const Scene& scene, EffectPlan& plan, Effect effect, bool asked, bool possible,
                   const std::string& off, const std::string& on) {
  const bool decided = asked && possible && wantsPicture(scene);
  plan.decisions.push_back({effect, decided,
                            !asked                 ? "not asked for"
                            : !wantsPicture(scene) ? "no picture is requested"
                            : decided              ? on
                                                   : off});
  return decided;
}

void planTissue(const Scene& scene, EffectPlan& plan) {
  const SpeckleSettings& s = scene.speckle;
  const std::string off = "there are no scatterers to carry it";
  plan.heterogeneity =
      decidePicture(scene, plan, Effect::heterogeneity, s.heterogeneity_db > 0, plan.speckle, off,
                    fmt::format("{:g} dB of variation within the tissue", s.heterogeneity_db));
  plan.anisotropy = decidePicture(
      scene, plan, Effect::anisotropy, s.anisotropy_db > 0, plan.speckle, off,
      fmt::format("muscle sends back {:g} dB less along its fibres", s.anisotropy_db));
  const Structure* coherent = nullptr;
  for (const Structure& structure : scene.structures)
    if (structure.coherent_share > 0 && !coherent) coherent = &structure;
  plan.coherent_echoes = decidePicture(
      scene, plan, Effect::coherent_echoes, coherent != nullptr, plan.speckle && plan.reflection,
      !plan.speckle ? "without speckle all echoes are whole" : "no interface sends back an echo",
      !coherent ? ""
                : fmt::format("{} sends back {:g} times as much in phase as at random",
                              coherent->name, coherent->coherent_share));
}

}  // namespace

void planPulse(const Scene& scene, EffectPlan& plan) {
  const SignalSettings& s = scene.signal;
  const bool sampled = plan.beam_width && s.beam_width == BeamWidth::profile &&
                       plan.rays_per_beam == 1 && scene.probe.lines > 1;
  const std::string off = "the beam is not the sampled profile";
  const double mhz = 1e-6 * scene.probe.frequency_hz;
  plan.harmonic =
      decidePicture(scene, plan, Effect::harmonic, s.harmonic, sampled, off,
                    fmt::format("sent at {:g} MHz, received at {:g} MHz", mhz / 2, mhz));
  plan.downshift = decidePicture(scene, plan, Effect::downshift, s.downshift, sampled, off,
                                 "attenuation takes more of the high frequencies");
  plan.receive_aperture =
      decidePicture(scene, plan, Effect::receive_aperture, s.receive_f_number > 0, sampled, off,
                    fmt::format("it is depth / {:g} wide near the face", s.receive_f_number));
}

void planGreyMap(const Scene& scene, EffectPlan& plan) {
  const SignalSettings& s = scene.signal;
  plan.edge_enhancement =
      decidePicture(scene, plan, Effect::edge_enhancement, s.edge_enhancement > 0, true, "",
                    fmt::format("differences from the mean over {:g} mm grow by {:g} %",
                                millimetresFromMetres(s.edge_size_m), 100 * s.edge_enhancement));
  decidePicture(scene, plan, Effect::grey_map, !GreyCurve(s).isIdentity(), true, "",
                fmt::format("gamma {:g}; the lowest {:g} % of the dynamic range are black, the "
                            "highest {:g} % bend to white",
                            s.grey_gamma, 100 * s.grey_toe, 100 * s.grey_shoulder));
}

void planTrabeculae(const Scene& scene, EffectPlan& plan) {
  const double height_m = scene.trabeculae.deviation_m;
  plan.trabeculae = std::any_of(scene.structures.begin(), scene.structures.end(),
                                [&](const Structure& s) { return hasTrabeculae(scene, s); });
  plan.decisions.push_back({Effect::trabeculae, plan.trabeculae,
                            height_m == 0      ? "trabeculae.height_mm is 0"
                            : !plan.trabeculae ? "no structure is a ventricle's cavity"
                                               : fmt::format("ridges of {:g} mm on the ventricles' "
                                                             "inner surfaces",
                                                             millimetresFromMetres(height_m))});
}

void planLeaflets(const Scene& scene, EffectPlan& plan) {
  const LeafletSettings& given = scene.leaflets;
  plan.leaflets = std::any_of(scene.structures.begin(), scene.structures.end(),
                              [&](const Structure& s) { return hasThickness(scene, s); });
  plan.decisions.push_back(
      {Effect::leaflets, plan.leaflets,
       given.thickness_m == 0 && given.cusp_m == 0 ? "leaflets.thickness_mm and cusp_mm are 0"
       : !plan.leaflets ? "no membrane is a leaflet or cusp with thickness"
                        : fmt::format("leaflets are {:g} mm thick, cusps {:g} mm; up to twice that "
                                      "at the free edge",
                                      millimetresFromMetres(given.thickness_m),
                                      millimetresFromMetres(given.cusp_m))});
}

namespace {

// Decides an effect of strands. missing: what the scene lacks for it; null: nothing.
bool decideStrands(const Scene& scene, EffectPlan& plan, Effect effect, const char* missing,
                   const std::string& on) {
  const char* omitted = missing                  ? missing
                        : !wantsPicture(scene)   ? "no picture is requested"
                        : !plan.backscatter      ? "they only scatter, and nothing scatters"
                        : plan.rays_per_beam > 1 ? "not with several rays per beam"
                        : scene.probe.lines < 2  ? "a single line has no beam's cell"
                                                 : nullptr;
  plan.decisions.push_back({effect, !omitted, omitted ? omitted : on});
  return !omitted;
}

}  // namespace

void planChordae(const Scene& scene, EffectPlan& plan) {
  const double diameter_m = scene.leaflets.chordae_m;
  const bool ends =
      structureOf(scene, Role::mitral_valve) && structureOf(scene, Role::papillary_muscle);
  plan.chordae =
      decideStrands(scene, plan, Effect::chordae,
                    diameter_m == 0 ? "leaflets.chordae_mm is 0"
                    : !ends         ? "no mitral valve with papillary muscles"
                                    : nullptr,
                    fmt::format("strands of {:g} mm between papillary muscles and mitral leaflets",
                                millimetresFromMetres(diameter_m)));
}

void planAnnulus(const Scene& scene, EffectPlan& plan) {
  const LeafletSettings& given = scene.leaflets;
  const bool valve =
      std::any_of(scene.structures.begin(), scene.structures.end(), [](const Structure& s) {
        const Role role = roleOf(s);
        return s.membrane && (role == Role::mitral_valve || role == Role::tricuspid_valve);
      });
  plan.annulus = decideStrands(
      scene, plan, Effect::annulus,
      given.annulus_m == 0 ? "leaflets.annulus_mm is 0"
      : !valve             ? "no membrane is a mitral or tricuspid leaflet"
                           : nullptr,
      fmt::format("fibrous rings of {:g} mm along the hinges of the leaflets, {:g} dB "
                  "above the leaflets",
                  millimetresFromMetres(given.annulus_m), given.annulus_db));
}

// A single medium without contrast still shows its scatterers.
void planSpeckle(const Scene& scene, EffectPlan& plan) {
  const bool echoes = plan.contrast || plan.backscatter;
  plan.speckle = scene.speckle.on && wantsPicture(scene) && echoes;
  plan.decisions.push_back(
      {Effect::speckle, plan.speckle,
       !scene.speckle.on      ? "speckle.on is false"
       : !wantsPicture(scene) ? "no picture is requested"
       : !echoes              ? std::string(kNothingSeen)
                 : fmt::format("{:g} scatterers per resolution cell move with the tissue",
                               scene.speckle.per_cell)});
  planTissue(scene, plan);
}

void planArtefacts(const Scene& scene, EffectPlan& plan) {
  const ArtefactSettings& a = scene.artefacts;
  const bool lines = scene.probe.lines > 1;
  const std::string one = "there is only one line",
                    inside = "a radial probe is inside the chest wall";
  const bool turn = scene.probe.isFullTurn();
  plan.dropout = decidePicture(scene, plan, Effect::dropout, a.dropout, lines && !turn,
                               turn ? "a radial probe has no outermost lines" : one,
                               fmt::format("outermost lines lose {:g} dB", a.dropout_db));
  plan.acoustic_window = decidePicture(
      scene, plan, Effect::acoustic_window, a.acoustic_window, !turn, inside,
      fmt::format("ribs leave {:g} mm open", millimetresFromMetres(a.window_width_m)));
  plan.shading = decidePicture(scene, plan, Effect::shading, a.shading, !turn, inside,
                               fmt::format("patches of {:g} mm in the chest wall vary by {:g} dB",
                                           millimetresFromMetres(a.shading_grain_m), a.shading_db));
  plan.lung = decidePicture(scene, plan, Effect::lung, a.lung, holdsAir(scene),
                            "no medium is filled with air",
                            fmt::format("mirrored tissue from {:g} dB on, fading over {:g} mm",
                                        a.lung_db, millimetresFromMetres(a.lung_length_m)));
  plan.haze =
      decidePicture(scene, plan, Effect::haze, a.haze, lines, one,
                    fmt::format("aberration and multiple scattering at {:g} dB", a.haze_db));
  plan.reverberation =
      decidePicture(scene, plan, Effect::reverberation, a.reverberation, scene.probe.samples > 1,
                    "there is only one sample",
                    fmt::format("a tail of {:g} dB behind every echo", a.reverberation_db));
  plan.clutter = decidePicture(scene, plan, Effect::clutter, a.clutter, true, "",
                               fmt::format("{:g} dB of white at the face", a.clutter_db));
  plan.noise = decidePicture(scene, plan, Effect::noise, a.noise, true, "",
                             fmt::format("{:g} dB of white at the largest gain", a.noise_db));
  plan.persistence =
      decidePicture(scene, plan, Effect::persistence, a.persistence > 0, true, "",
                    fmt::format("each frame holds {:g} of the one before", a.persistence));
}

}  // namespace echocine
