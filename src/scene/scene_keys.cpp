// The table of scene keys: one row each, and no other list of them.

#include "scene/scene_keys.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "scene/key_parts.h"

namespace echocine {

using namespace key_parts;

namespace {

// A member that the JSON has by its name, and one that it has in another form.
#define AT(Part, member) key_field::of<&Part::member>(#member)
#define AS(Part, member) key_field::of<&Part::member>(nullptr)

// A default is its member's initial value. The last column has those of the probe, our choice: the
// 20 mm footprint of an adult cardiac probe, and the sector and frequency of one that a view
// places.
// clang-format off
constexpr SceneKey kKeys[] = {
    {"", "background", kNone, kAny, "medium outside every structure", kByHand},
    {"", "unit_volume_cm3", kCm3, ranges::kUnitVolume_cm3, "V of Eq. 4", AT(Scene, unit_volume_m3)},

    {"probe", "kind", kNone, kAny, "geometry of the scan lines", AT(Probe, kind)},
    {"probe", "apex", kMeshUnit, kCoordinate, "where the scan lines meet; linear: the middle of the face", kByHand, kUnlessView},
    {"probe", "axis", kNone, kAny, "depth direction", kByHand, kUnlessView},
    {"probe", "lateral", kNone, kAny, "image x; made perpendicular to axis", kByHand, kUnlessView},
    {"probe", "sector_deg", kDeg, ranges::kSector_deg, "full angle of the sector", kSector, kUnlessView, kWithAngle, 80},
    {"probe", "view", kNone, kAny, "standard view, found from structures with roles; replaces apex, axis and lateral", kViews},
    {"probe", "shift_mm", kMm, kShift_mm, "moves the view's probe along its lateral, elevation and depth axes", kByHand, kOptional, kWithView},
    {"probe", "tilt_deg", kDeg, ranges::kTilt_deg, "turns the view's plane about its lateral axis, depth towards elevation", AS(ViewPlacement, tilt_rad), kOptional, kWithView},
    {"probe", "rotate_deg", kDeg, ranges::kRotate_deg, "turns the view's plane about its depth axis, lateral towards elevation", AS(ViewPlacement, rotate_rad), kOptional, kWithView},
    {"probe", "face_radius_mm", kMm, ranges::kRadius_mm, "from apex to face", AT(Probe, face_radius_m), kAlways, kWithCurve},
    {"probe", "width_mm", kMm, ranges::kExtent_mm, "length of the face", kWidth, kAlways, kWithWidth},
    {"probe", "min_depth_mm", kMm, ranges::kNearEnd_mm, "path length from the face to the first sample", AT(Probe, min_depth_m), kOptional, {}, 2},
    {"probe", "depth_mm", kMm, ranges::kExtent_mm, "path length from the face to the last sample", kDepth, kUnlessView},
    {"probe", "frequency_mhz", kMhz, kFrequency_mhz, "centre frequency of the pulse", AT(Probe, frequency_hz), kUnlessView, {}, 2.5},
    {"probe", "lines", kNone, kLines, "scan lines", AT(Probe, lines), kOptional, {}, 256},
    {"probe", "samples", kNone, kSamples, "samples of a scan line", AT(Probe, samples), kOptional, {}, 1024},
    {"probe", "aperture_mm", kMm, ranges::kExtent_mm, "active lateral aperture of a beam", AT(Probe, aperture_m), kOptional, {}, 20},
    {"probe", "focus_mm", kMm, ranges::kRadius_mm, "depth of the transmit focus; half of depth_mm if left out", kFocus, kFound},
    {"probe", "receive_apodization", kNone, kAny, "weights of the receiving elements, for beam_width = \"profile\" and speckle", AT(Probe, receive_apodization)},
    {"probe", "bandwidth", kNone, ranges::kBandwidth, "two-way -6 dB bandwidth over the centre frequency, for beam_width = \"profile\"", AT(Probe, bandwidth)},
    {"probe", "elevation_aperture_mm", kMm, ranges::kExtent_mm, "aperture of the fixed lens across the imaging plane", AT(Probe, elevation_aperture_m)},
    {"probe", "elevation_focus_mm", kMm, ranges::kRadius_mm, "focus of that lens", AT(Probe, elevation_focus_m)},

    {"acquisition", "heart_rate_bpm", kBpm, ranges::kHeartRates_bpm, "heart rate of the loop, the mean where beats vary", AT(Acquisition, heart_rate_hz)},
    {"acquisition", "frame_rate_hz", kHz, kFrameRate_hz, "frames per second", AT(Acquisition, frame_rate_hz)},
    {"acquisition", "beats", kNone, ranges::kBeats, "length of the loop in beats", AT(Acquisition, beats)},
    {"acquisition", "time_warp", kNone, kAny, "how keyframes of another heart rate are played; systole keeps the length of systole nearly, auto does where that rate is given", AT(Acquisition, time_warp)},
    {"acquisition", "rr_variability", kNone, kVariability, "standard deviation over mean of the beats' durations", AT(Acquisition, rr_variability)},
    {"acquisition", "seed", kNone, kSeed, "of the beats' durations and of the rays of a beam", AT(Acquisition, seed)},
    {"acquisition", "rolling", kNone, kAny, "acquires lines one after the other; the frame's time is that of its middle", AT(Acquisition, rolling)},
    {"acquisition", "rolling_share", kNone, ranges::kRollingShare, "share of the frame's interval in which all lines are acquired", AT(Acquisition, rolling_share)},

    {"motion", "mesh_unit", kNone, kAny, "unit of the meshes and of the probe's apex", kMeshUnitField},
    {"motion", "mesh_scale", kNone, ranges::kMeshScale, "factor of all meshes' coordinates; the probe is not scaled", AT(MotionSettings, mesh_scale)},
    {"motion", "mesh_offset_mm", kMm, kOffset_mm, "added to the scaled coordinates", kByHand},
    {"motion", "interpolation", kNone, kAny, "between keyframes, periodic; cycle if left out with fewer than 5 keyframes", AT(MotionSettings, interpolation)},
    {"motion", "subdivision", kNone, kSubdivision, "Loop levels after interpolation", AT(MotionSettings, subdivision)},
    {"motion", "keyframe_heart_rate_bpm", kBpm, ranges::kHeartRates_bpm, "heart rate that the keyframes show; without it they are played evenly", AT(MotionSettings, keyframe_heart_rate_hz)},
    {"motion", "end_systole_phase", kNone, kEndSystole, "phase of end-systole in the keyframes; as published for their rate if left out", AT(MotionSettings, end_systole_phase)},
    {"motion", "keyframe_interval_ms", kMs, ranges::kKeyframeInterval_ms, "between evenly spaced keyframes; replaces keyframe_heart_rate_bpm and sets the loop's rate", kByHand},
    {"motion", "keyframe_phases", kNone, kPhase, "phases of keyframes without their own, ascending; evenly spaced if left out", kByHand},

    {"structure", "name", kNone, kAny, "a name of its own", kByHand, kAlways},
    {"structure", "medium", kNone, kAny, "from data/media.toml or [media.NAME]", kByHand, kAlways},
    {"structure", "role", kNone, kAny, "what it is in the heart; guessed from the name if left out", AT(Structure, role), kFound},
    {"structure", "membrane", kNone, kAny, "an open sheet of a thin material: reflects twice, encloses nothing", AT(Structure, membrane)},
    {"structure", "priority", kNone, kPriority, "where closed structures overlap the highest wins, then the later one", AT(Structure, priority), kOptional, kClosed},
    {"structure", "keyframes", kNone, kPhase, "files of the meshes over the beat, or a list of { file, phase }", kByHand, kAlways},
    {"structure", "lids", kNone, kAny, "meshes that close each keyframe, welded at their rims", kByHand},
    {"structure", "reflection_gain", kNone, ranges::kReflectionGain, "factor of R in W of W cos^n", AT(Structure, reflection_gain)},
    {"structure", "reflection_exponent", kNone, kExponent, "n of W cos^n", AT(Structure, reflection_exponent)},
    {"structure", "coherent_share", kNone, ranges::kCoherentShare, "with speckle: coherent over random power of its interface's echo", AT(Structure, coherent_share)},
    {"structure", "repair", kNone, kAny, "repairs of every keyframe before the checks", kRepairs},

    {"media", "density_kg_m3", kDensity, ranges::kDensity_kg_m3, "density", AS(MediumSpec, density_kg_m3), kAlways},
    {"media", "sound_speed_m_s", kSpeed, ranges::kSoundSpeed_m_s, "sound speed", AS(MediumSpec, sound_speed_m_s), kAlways},
    {"media", "attenuation_db_cm_mhz", kAttenuation, ranges::kAttenuation_db_cm_mhz, "a of alpha = a f^b, amplitude", AS(MediumSpec, attenuation_db_cm_mhz), kAlways},
    {"media", "attenuation_exponent", kNone, kAttenuationExponent, "b of alpha = a f^b", AS(MediumSpec, attenuation_exponent)},
    {"media", "blood", kNone, kAny, "it flows: scatterers are not tied to walls, no displacement; if left out, by the law of the backscatter", kByHand},
    {"media.backscatter", "kind", kNone, kAny, "law of the backscatter: blood by Eqs. 5 and 6, tissue by Eq. 7", kLaws, kAlways},
    {"media.backscatter", "per_cm_sr", kScattering, ranges::kBackscatter_per_cm_sr, "eta_b of kind fixed", kByHand},
    {"media.backscatter", "velocity_variation", kNone, kShare, "mu of kind tissue", kByHand},
    {"media.backscatter", "correlation_length_um", kUm, ranges::kCorrelationLength_um, "b_m of kind tissue", kByHand},
    {"media.backscatter", "hematocrit", kNone, kShare, "W_0 of kind blood", kByHand},
    {"media.backscatter", "cell_radius_um", kUm, ranges::kCellRadius_um, "a of kind blood", kByHand},
    {"media.backscatter", "cell_density_kg_m3", kDensity, ranges::kDensity_kg_m3, "rho_e of kind blood", kByHand},
    {"media.backscatter", "cell_compressibility_cm2_dyn", kCompressibility, ranges::kCompressibility_cm2_dyn, "G_e of kind blood", kByHand},
    {"media.backscatter", "plasma", kNone, kAny, "medium around the cells of kind blood", kByHand},

    {"speckle", "on", kNone, kAny, "coherent echoes of scatterers that move with the tissue; the mean over seeds is the picture without", AT(SpeckleSettings, on)},
    {"speckle", "seed", kNone, kSeed, "of the scatterers", AT(SpeckleSettings, seed)},
    {"speckle", "per_cell", kNone, kPerCell, "scatterers per resolution cell; first-order statistics are final from 3 on", AT(SpeckleSettings, per_cell)},
    {"speckle", "smoothing_mm", kMm, kSmoothing_mm, "along the lines, of the speckle alone: full width at half maximum", AT(SpeckleSettings, smoothing_m)},
    {"speckle", "tissue_time_ms", kMs, kTimes_ms, "after which tissue's scatterers are new ones; 0: never", AT(SpeckleSettings, tissue_time_s)},
    {"speckle", "blood_time_ms", kMs, kTimes_ms, "after which scatterers of media with the law of blood are new ones; 0: never", AT(SpeckleSettings, blood_time_s)},
    {"speckle", "heterogeneity_db", kDb, ranges::kHeterogeneity_db, "standard deviation of log-normal backscatter that stays with the tissue, mean 1; not of blood", AT(SpeckleSettings, heterogeneity_db)},
    {"speckle", "heterogeneity_fine_mm", kMm, ranges::kArtefactLength_mm, "size of the spots that are half of it", AT(SpeckleSettings, heterogeneity_fine_m)},
    {"speckle", "heterogeneity_layer_mm", kMm, ranges::kArtefactLength_mm, "thickness of the layers across the beam that are the other half", AT(SpeckleSettings, heterogeneity_layer_m)},
    {"speckle", "heterogeneity_coarse_mm", kMm, ranges::kArtefactLength_mm, "width of these layers at the middle depth", AT(SpeckleSettings, heterogeneity_coarse_m)},
    {"speckle", "heterogeneity_seed", kNone, kSeed, "of the heterogeneity", AT(SpeckleSettings, heterogeneity_seed)},
    {"speckle", "anisotropy_db", kDb, ranges::kLoss_db, "backscatter of the left wall's fibres along themselves, below that across", AT(SpeckleSettings, anisotropy_db)},
    {"speckle", "helix_angle_deg", kDeg, ranges::kHelix_deg, "of those fibres, from this at the endocardium to its negative at the epicardium", AT(SpeckleSettings, helix_angle_rad)},

    {"trabeculae", "height_mm", kMm, ranges::kTrabeculae_mm, "standard deviation about the mesh; valves, outflow and the septum's left side are smooth", AT(TrabeculaeSettings, deviation_m)},
    {"trabeculae", "scale_mm", kMm, ranges::kTrabeculaeScale_mm, "of a ridge, no finer than two edges of the mesh", AT(TrabeculaeSettings, scale_m)},
    {"trabeculae", "seed", kNone, kSeed, "of the relief", AT(TrabeculaeSettings, seed)},

    {"artefacts", "dropout", kNone, kAny, "lost contact towards the sector's edges", AT(ArtefactSettings, dropout)},
    {"artefacts", "dropout_db", kDb, ranges::kLoss_db, "loss on the outermost lines", AT(ArtefactSettings, dropout_db)},
    {"artefacts", "acoustic_window", kNone, kAny, "ribs shade part of the aperture", AT(ArtefactSettings, acoustic_window)},
    {"artefacts", "window_width_mm", kMm, ranges::kArtefactLength_mm, "width of the gap between the ribs", AT(ArtefactSettings, window_width_m)},
    {"artefacts", "window_offset_mm", kMm, ranges::kWindowOffset_mm, "middle of that gap, along probe.lateral", AT(ArtefactSettings, window_offset_m)},
    {"artefacts", "window_depth_mm", kMm, ranges::kArtefactLength_mm, "depth of the ribs, from the face", AT(ArtefactSettings, window_depth_m)},
    {"artefacts", "window_shadow_db", kDb, ranges::kLoss_db, "loss in a whole shadow, both ways", AT(ArtefactSettings, window_shadow_db)},
    {"artefacts", "haze", kNone, kAny, "aberration and multiple scattering: a two-sided exponential across the lines", AT(ArtefactSettings, haze)},
    {"artefacts", "haze_db", kDb, ranges::kLevel_db, "level over the echoes that it gathers", AT(ArtefactSettings, haze_db)},
    {"artefacts", "haze_width_deg", kDeg, ranges::kArtefactWidth_deg, "where it has fallen to 1/e; linear probes: as an arc at the middle depth", AT(ArtefactSettings, haze_width_rad)},
    {"artefacts", "reverberation", kNone, kAny, "a tail behind every echo", AT(ArtefactSettings, reverberation)},
    {"artefacts", "reverberation_db", kDb, ranges::kLevel_db, "level over the echo", AT(ArtefactSettings, reverberation_db)},
    {"artefacts", "reverberation_length_mm", kMm, ranges::kArtefactLength_mm, "where it has fallen to 1/e", AT(ArtefactSettings, reverberation_length_m)},
    {"artefacts", "clutter", kNone, kAny, "of the near field; it stands still", AT(ArtefactSettings, clutter)},
    {"artefacts", "clutter_db", kDb, ranges::kLevel_db, "level over white, at the face", AT(ArtefactSettings, clutter_db)},
    {"artefacts", "clutter_length_mm", kMm, ranges::kArtefactLength_mm, "where it has fallen to 1/e", AT(ArtefactSettings, clutter_length_m)},
    {"artefacts", "clutter_width_deg", kDeg, ranges::kArtefactWidth_deg, "of its grain, full width at half maximum", AT(ArtefactSettings, clutter_width_rad)},
    {"artefacts", "clutter_seed", kNone, kSeed, "of the clutter", AT(ArtefactSettings, clutter_seed)},
    {"artefacts", "noise", kNone, kAny, "of the receiver, which the time gain raises", AT(ArtefactSettings, noise)},
    {"artefacts", "noise_db", kDb, ranges::kLevel_db, "level over white, where the gain is largest", AT(ArtefactSettings, noise_db)},
    {"artefacts", "noise_seed", kNone, kSeed, "of the noise", AT(ArtefactSettings, noise_seed)},
    {"artefacts", "persistence", kNone, ranges::kPersistence, "weight of each frame over that of the next one", AT(ArtefactSettings, persistence)},

    {"truth", "write", kNone, kAny, "a list of kinds of files in truth/", kTruths},
    {"truth", "labels", kNone, kLabel, "numbers of the label pictures by structure or role; closed ones from 1 in their order if left out", kByHand},
    {"truth", "papillary", kNone, kAny, "what papillary muscles count as in the label pictures", kPapillary},
    {"truth", "tracks", kNone, kTracks, "material points", AT(TruthSettings, track_count)},

    {"signal", "look", kNone, kAny, "other defaults of [signal], [trabeculae], [speckle], [artefacts] and accuracy.elevation_slices; given keys win", AT(SignalSettings, look)},
    {"signal", "quality", kNone, kAny, "grade of look scanner", AT(SignalSettings, quality), kOptional, kWithQuality},
    {"signal", "tgc", kNone, kAny, "time gain: perfect undoes each path's attenuation, mean the loop's mean by depth, nominal that of soft tissue", AT(SignalSettings, tgc)},
    {"signal", "tgc_nominal_db_cm_mhz", kNominalGain, ranges::kNominalGain_db_cm_mhz, "attenuation that the nominal gain undoes", AT(SignalSettings, nominal_gain_np_per_m_hz), kOptional, kWithNominal},
    {"signal", "tgc_table_mm_db", kNone, kAny, "pairs of depth and gain", kByHand, kAlways, kWithTable},
    {"signal", "spread", kNone, kAny, "1/l^2 of the backscattered part in the picture", AT(SignalSettings, spread)},
    {"signal", "beam_width", kNone, kAny, "focused: by aperture, frequency and focus; profile: the sampled two-way beam with its side lobes", AT(SignalSettings, beam_width)},
    {"signal", "beam_width_mm", kMm, ranges::kExtent_mm, "width of a fixed beam", AT(SignalSettings, beam_width_m), kAlways, kWithFixed},
    {"signal", "pulse_cycles", kNone, kPulse, "length of the pulse; axial average over half of it, 0: one sample", AT(SignalSettings, pulse_cycles)},
    {"signal", "dynamic_range_db", kDb, ranges::kDynamicRange_db, "from white to black", AT(SignalSettings, dynamic_range_db)},
    {"signal", "reference_percentile", kNone, kPercentileRange, "white: percentile over the loop's frames, near field left out; without the key by the heart's muscle", kPercentile, kFound, kWithPercentile},
    {"signal", "reference_intensity", kNone, ranges::kReferenceIntensity, "white as an intensity relative to I_S", AT(SignalSettings, reference_intensity)},
    {"signal", "gain_db", kDb, ranges::kPictureGain_db, "of the picture: white is so far below the reference", AT(SignalSettings, gain_db)},
    {"signal", "interface_gain_db", kDb, ranges::kPictureGain_db, "of interface echoes against tissue, in the picture alone", AT(SignalSettings, interface_gain_db)},
    {"signal", "interface_limit_db", kDb, ranges::kLevel_db, "echoes E become E / (1 + E / limit) in the picture, limit relative to I_S; no limit if left out", AT(SignalSettings, interface_limit_db)},
    {"signal", "grey_gamma", kNone, ranges::kGamma, "grey = c^gamma, c the position in the dynamic range, bent by toe and shoulder", AT(SignalSettings, grey_gamma)},
    {"signal", "grey_toe", kNone, ranges::kGreyToe, "lowest share of the dynamic range that is black", AT(SignalSettings, grey_toe)},
    {"signal", "grey_shoulder", kNone, ranges::kGreyShoulder, "highest share of the dynamic range, over which the slope falls to 0 at white", AT(SignalSettings, grey_shoulder)},

    {"accuracy", "rays_per_beam", kNone, kRays, "from 2 on averaged over the beam's profile across and along the lines, in Y too; embree only", AT(AccuracySettings, rays_per_beam)},
    {"accuracy", "elevation_slices", kNone, kSlices, "1, 3 or 5 slices across the plane, averaged over the beam of the lens; plane slice only", AT(AccuracySettings, elevation_slices)},
    {"accuracy", "tracer", kNone, kAny, "plane slice of the meshes, or rays in space", AT(AccuracySettings, tracer)},
    {"accuracy", "interface_echo", kNone, kAny, "at each line, or integrated between lines (one ray per beam)", AT(AccuracySettings, interface_echo)},
    {"accuracy", "normals", kNone, kAny, "of the facets, or of the Loop limit surface; auto: smooth where rays bend", AT(AccuracySettings, normals)},
    {"accuracy", "refraction_tolerance_beam_widths", kNone, ranges::kToleranceLines, "refraction auto is off while echoes move less than this in the worst part of image and beat", AT(AccuracySettings, refraction_tolerance_beam_widths)},
    {"accuracy", "rolling_lines", kNone, kLines, "with acquisition.rolling: neighbouring lines that share the instant of their middle", AT(AccuracySettings, rolling_lines)},
    {"accuracy", "tolerance_db", kDb, ranges::kTolerance_db, "sets lines, samples and the accuracy as cheaply as the picture stays this near, RMS, to the finest", kByHand},

    {"output", "exr", kNone, kAny, "intensity/frame_*.exr", AT(OutputSettings, exr)},
    {"output", "channels", kNone, kAny, "a list of channels of the EXR; from structure.id on they are truth, in mm and mm/s", kChannels},
    {"output", "exr_compression", kNone, kAny, "pxr24 keeps 24-bit floats: errs by up to 2^-16", AT(OutputSettings, exr_compression)},
    {"output", "exr_pixel", kNone, kAny, "half errs by up to 2^-11 down to 84 dB below the channel's largest value", AT(OutputSettings, exr_pixel)},
    {"output", "cine", kNone, kAny, "cine.avi", AT(OutputSettings, cine)},
    {"output", "codec", kNone, kAny, "of cine.avi; ffv1 is lossless", AT(OutputSettings, codec)},
    {"output", "jpeg_quality", kNone, kQuality, "of codec mjpg", AT(OutputSettings, jpeg_quality)},
    {"output", "png", kNone, kAny, "png/frame_*.png", AT(OutputSettings, png)},
    {"output", "report", kNone, kAny, "report.html: the run on one page", AT(OutputSettings, report)},
    {"output", "width", kPx, kPixels, "of the picture", AT(OutputSettings, width)},
    {"output", "height", kPx, kPixels, "of the picture", AT(OutputSettings, height)},
    {"output", "ecg", kNone, kAny, "the ECG below the picture", AT(OutputSettings, ecg)},
    {"output", "depth_ticks", kNone, kAny, "ticks beside the picture", AT(OutputSettings, depth_ticks)},
};
// clang-format on

#undef AT
#undef AS

// The rows of kEffectSwitches as keys of [effects].
template <std::size_t... kRows>
std::vector<SceneKey> effectKeys(std::index_sequence<kRows...>) {
  return {{"effects", kEffectSwitches[kRows].name, kNone, kAny, kEffectSwitches[kRows].meaning,
           key_field::of<kEffectSwitches[kRows].wanted>(kEffectSwitches[kRows].name)}...};
}

std::vector<SceneKey> allKeys() {
  std::vector<SceneKey> keys(std::begin(kKeys), std::end(kKeys));
  const std::vector<SceneKey> effects =
      effectKeys(std::make_index_sequence<std::size(kEffectSwitches)>());
  const auto after_media = std::find_if(keys.begin(), keys.end(), [](const SceneKey& key) {
    return std::string_view(key.table) == "speckle";
  });
  keys.insert(after_media, effects.begin(), effects.end());
  return keys;
}

}  // namespace

std::span<const SceneKey> sceneKeys() {
  static const std::vector<SceneKey> keys = allKeys();
  return keys;
}

}  // namespace echocine
