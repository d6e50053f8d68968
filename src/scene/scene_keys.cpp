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
    {"", "unit_volume_cm3", kCm3, ranges::kUnitVolume_cm3, "unit volume V of Eq. 4", AT(Scene, unit_volume_m3)},

    {"probe", "kind", kNone, kAny, "geometry of the scan lines", AT(Probe, kind)},
    {"probe", "apex", kMeshUnit, kCoordinate, "intersection of the scan lines; for a linear probe, the centre of its face", kByHand, kUnlessView},
    {"probe", "axis", kNone, kAny, "depth direction", kByHand, kUnlessView},
    {"probe", "lateral", kNone, kAny, "direction of image x; made perpendicular to axis", kByHand, kUnlessView},
    {"probe", "sector_deg", kDeg, ranges::kSector_deg, "full angle of the sector", kSector, kUnlessView, kWithAngle, 80},
    {"probe", "view", kNone, kAny, "standard view, found from structures with roles; replaces apex, axis and lateral", kViews},
    {"probe", "shift_mm", kMm, kShift_mm, "moves the view's probe along its lateral, elevation and depth axes", kByHand, kOptional, kWithView},
    {"probe", "tilt_deg", kDeg, ranges::kTilt_deg, "rotates the view's plane about its lateral axis; positive turns depth towards elevation", AS(ViewPlacement, tilt_rad), kOptional, kWithView},
    {"probe", "rotate_deg", kDeg, ranges::kRotate_deg, "rotates the view's plane about its depth axis; positive turns lateral towards elevation", AS(ViewPlacement, rotate_rad), kOptional, kWithView},
    {"probe", "face_radius_mm", kMm, ranges::kRadius_mm, "distance from apex to face", AT(Probe, face_radius_m), kAlways, kWithCurve},
    {"probe", "width_mm", kMm, ranges::kExtent_mm, "length of the face", kWidth, kAlways, kWithWidth},
    {"probe", "min_depth_mm", kMm, ranges::kNearEnd_mm, "path length from the face to the first sample", AT(Probe, min_depth_m), kOptional, {}, 2},
    {"probe", "depth_mm", kMm, ranges::kExtent_mm, "path length from the face to the last sample", kDepth, kUnlessView},
    {"probe", "frequency_mhz", kMhz, kFrequency_mhz, "centre frequency of the pulse", AT(Probe, frequency_hz), kUnlessView, {}, 2.5},
    {"probe", "lines", kNone, kLines, "number of scan lines", AT(Probe, lines), kOptional, {}, 256},
    {"probe", "samples", kNone, kSamples, "number of samples on a scan line", AT(Probe, samples), kOptional, {}, 1024},
    {"probe", "aperture_mm", kMm, ranges::kExtent_mm, "active lateral aperture of a beam", AT(Probe, aperture_m), kOptional, {}, 20},
    {"probe", "focus_mm", kMm, ranges::kRadius_mm, "depth of the transmit focus; half of depth_mm if left out", kFocus, kFound},
    {"probe", "receive_apodization", kNone, kAny, "weights of the receiving elements, for beam_width = \"profile\" and speckle", AT(Probe, receive_apodization)},
    {"probe", "bandwidth", kNone, ranges::kBandwidth, "two-way -6 dB bandwidth over the centre frequency, for beam_width = \"profile\"", AT(Probe, bandwidth)},
    {"probe", "elevation_aperture_mm", kMm, ranges::kExtent_mm, "aperture of the fixed lens across the imaging plane", AT(Probe, elevation_aperture_m)},
    {"probe", "elevation_focus_mm", kMm, ranges::kRadius_mm, "focus of that lens", AT(Probe, elevation_focus_m)},

    {"acquisition", "heart_rate_bpm", kBpm, ranges::kHeartRates_bpm, "heart rate of the loop; the mean if beats vary", AT(Acquisition, heart_rate_hz)},
    {"acquisition", "frame_rate_hz", kHz, kFrameRate_hz, "frames per second", AT(Acquisition, frame_rate_hz)},
    {"acquisition", "beats", kNone, ranges::kBeats, "length of the loop in beats", AT(Acquisition, beats)},
    {"acquisition", "time_warp", kNone, kAny, "playback of keyframes at another heart rate: systole nearly keeps the duration of systole, uniform scales the beat; auto is systole if the keyframes' rate is given", AT(Acquisition, time_warp)},
    {"acquisition", "rr_variability", kNone, kVariability, "standard deviation divided by mean of the beat durations", AT(Acquisition, rr_variability)},
    {"acquisition", "seed", kNone, kSeed, "seed of the beat durations and of the rays of a beam", AT(Acquisition, seed)},
    {"acquisition", "rolling", kNone, kAny, "acquires the lines one after the other; the frame's time is that of its middle line", AT(Acquisition, rolling)},
    {"acquisition", "rolling_share", kNone, ranges::kRollingShare, "share of the frame interval in which all lines are acquired", AT(Acquisition, rolling_share)},

    {"motion", "mesh_unit", kNone, kAny, "unit of the meshes and of the probe's apex", kMeshUnitField},
    {"motion", "mesh_scale", kNone, ranges::kMeshScale, "scale factor of all mesh coordinates; the probe is not scaled", AT(MotionSettings, mesh_scale)},
    {"motion", "mesh_offset_mm", kMm, kOffset_mm, "offset added to the scaled coordinates", kByHand},
    {"motion", "interpolation", kNone, kAny, "periodic interpolation between keyframes; cycle if left out with fewer than 5 keyframes", AT(MotionSettings, interpolation)},
    {"motion", "subdivision", kNone, kSubdivision, "number of refinements by Loop subdivision, after interpolation", AT(MotionSettings, subdivision)},
    {"motion", "keyframe_heart_rate_bpm", kBpm, ranges::kHeartRates_bpm, "heart rate of the keyframes; without it the beat is scaled uniformly", AT(MotionSettings, keyframe_heart_rate_hz)},
    {"motion", "end_systole_phase", kNone, kEndSystole, "phase of end-systole in the keyframes; if left out, the usual phase at their heart rate", AT(MotionSettings, end_systole_phase)},
    {"motion", "keyframe_interval_ms", kMs, ranges::kKeyframeInterval_ms, "time between evenly spaced keyframes; replaces keyframe_heart_rate_bpm and sets the loop's heart rate", kByHand},
    {"motion", "keyframe_phases", kNone, kPhase, "ascending phases of keyframes without a phase in their structure; evenly spaced if left out", kByHand},

    {"structure", "name", kNone, kAny, "unique name", kByHand, kAlways},
    {"structure", "medium", kNone, kAny, "medium, from data/media.toml or [media.NAME]", kByHand, kAlways},
    {"structure", "role", kNone, kAny, "anatomical role; guessed from the name if left out", AT(Structure, role), kFound},
    {"structure", "membrane", kNone, kAny, "an open sheet of thin material: it has two faces that reflect, and no inside", AT(Structure, membrane)},
    {"structure", "priority", kNone, kPriority, "where closed structures overlap, the highest priority wins; among equals, the later structure", AT(Structure, priority), kOptional, kClosed},
    {"structure", "keyframes", kNone, kPhase, "mesh files over the beat, a NumPy file of all keyframes, or a list of { file, phase }", kByHand, kAlways},
    {"structure", "lids", kNone, kAny, "meshes that close each keyframe, welded at their rims", kByHand},
    {"structure", "reflection_gain", kNone, ranges::kReflectionGain, "factor of R in the wall's reflection W cos^n", AT(Structure, reflection_gain)},
    {"structure", "reflection_exponent", kNone, kExponent, "exponent n of W cos^n", AT(Structure, reflection_exponent)},
    {"structure", "coherent_share", kNone, ranges::kCoherentShare, "with speckle: ratio of coherent to random power of the interface's echo", AT(Structure, coherent_share)},
    {"structure", "repair", kNone, kAny, "repairs applied to every keyframe before the checks", kRepairs},

    {"media", "density_kg_m3", kDensity, ranges::kDensity_kg_m3, "density", AS(MediumSpec, density_kg_m3), kAlways},
    {"media", "sound_speed_m_s", kSpeed, ranges::kSoundSpeed_m_s, "sound speed", AS(MediumSpec, sound_speed_m_s), kAlways},
    {"media", "attenuation_db_cm_mhz", kAttenuation, ranges::kAttenuation_db_cm_mhz, "a of the amplitude attenuation alpha = a f^b", AS(MediumSpec, attenuation_db_cm_mhz), kAlways},
    {"media", "attenuation_exponent", kNone, kAttenuationExponent, "b of the amplitude attenuation alpha = a f^b", AS(MediumSpec, attenuation_exponent)},
    {"media", "blood", kNone, kAny, "true: the medium flows, so its scatterers do not follow walls and have no displacement; if left out, true for backscatter kind blood", kByHand},
    {"media.backscatter", "kind", kNone, kAny, "law of the backscatter: blood by Eqs. 5 and 6, tissue by Eq. 7", kLaws, kAlways},
    {"media.backscatter", "per_cm_sr", kScattering, ranges::kBackscatter_per_cm_sr, "eta_b of kind fixed", kByHand},
    {"media.backscatter", "velocity_variation", kNone, kShare, "mu of kind tissue", kByHand},
    {"media.backscatter", "correlation_length_um", kUm, ranges::kCorrelationLength_um, "b_m of kind tissue", kByHand},
    {"media.backscatter", "hematocrit", kNone, kShare, "W_0 of kind blood", kByHand},
    {"media.backscatter", "cell_radius_um", kUm, ranges::kCellRadius_um, "a of kind blood", kByHand},
    {"media.backscatter", "cell_density_kg_m3", kDensity, ranges::kDensity_kg_m3, "rho_e of kind blood", kByHand},
    {"media.backscatter", "cell_compressibility_cm2_dyn", kCompressibility, ranges::kCompressibility_cm2_dyn, "G_e of kind blood", kByHand},
    {"media.backscatter", "plasma", kNone, kAny, "medium around the cells of kind blood", kByHand},

    {"speckle", "on", kNone, kAny, "coherent echoes of scatterers that move with the tissue; their mean over seeds is the picture without speckle", AT(SpeckleSettings, on)},
    {"speckle", "seed", kNone, kSeed, "seed of the scatterers", AT(SpeckleSettings, seed)},
    {"speckle", "per_cell", kNone, kPerCell, "scatterers per resolution cell; more than 3 do not change first-order statistics", AT(SpeckleSettings, per_cell)},
    {"speckle", "smoothing_mm", kMm, kSmoothing_mm, "smoothing of the speckle along the lines: full width at half maximum", AT(SpeckleSettings, smoothing_m)},
    {"speckle", "tissue_time_ms", kMs, kTimes_ms, "renewal time of tissue scatterers; 0: never renewed", AT(SpeckleSettings, tissue_time_s)},
    {"speckle", "surroundings_time_ms", kMs, kTimes_ms, "renewal time of the background's scatterers and those of still surroundings, such as chest wall and lung; 0: as tissue_time_ms", AT(SpeckleSettings, surroundings_time_s)},
    {"speckle", "blood_time_ms", kMs, kTimes_ms, "renewal time of blood scatterers; 0: never renewed", AT(SpeckleSettings, blood_time_s)},
    {"speckle", "heterogeneity_db", kDb, ranges::kHeterogeneity_db, "standard deviation of a log-normal factor of backscatter, with mean 1, fixed to the tissue; not in blood", AT(SpeckleSettings, heterogeneity_db)},
    {"speckle", "heterogeneity_fine_mm", kMm, ranges::kArtefactLength_mm, "size of the isotropic spots, one half of the heterogeneity", AT(SpeckleSettings, heterogeneity_fine_m)},
    {"speckle", "heterogeneity_layer_mm", kMm, ranges::kArtefactLength_mm, "thickness of the layers across the beam, the other half of the heterogeneity", AT(SpeckleSettings, heterogeneity_layer_m)},
    {"speckle", "heterogeneity_coarse_mm", kMm, ranges::kArtefactLength_mm, "width of these layers at the middle depth", AT(SpeckleSettings, heterogeneity_coarse_m)},
    {"speckle", "heterogeneity_seed", kNone, kSeed, "seed of the heterogeneity", AT(SpeckleSettings, heterogeneity_seed)},
    {"speckle", "anisotropy_db", kDb, ranges::kLoss_db, "decrease of the left wall's backscatter along its fibres, relative to across them", AT(SpeckleSettings, anisotropy_db)},
    {"speckle", "helix_angle_deg", kDeg, ranges::kHelix_deg, "angle of these fibres at the endocardium; its negative at the epicardium", AT(SpeckleSettings, helix_angle_rad)},

    {"trabeculae", "height_mm", kMm, ranges::kTrabeculae_mm, "standard deviation of the relief; valves, outflow tract and the septum's left side stay smooth", AT(TrabeculaeSettings, deviation_m)},
    {"trabeculae", "scale_mm", kMm, ranges::kTrabeculaeScale_mm, "size of a ridge; at least two mesh edges", AT(TrabeculaeSettings, scale_m)},
    {"trabeculae", "seed", kNone, kSeed, "seed of the relief", AT(TrabeculaeSettings, seed)},

    {"leaflets", "thickness_mm", kMm, ranges::kLeaflet_mm, "thickness of mitral and tricuspid leaflets near the hinge; the free edge has up to twice as much", AT(LeafletSettings, thickness_m)},
    {"leaflets", "cusp_mm", kMm, ranges::kLeaflet_mm, "the same for aortic and pulmonary cusps", AT(LeafletSettings, cusp_m)},
    {"leaflets", "chordae_mm", kMm, ranges::kChordae_mm, "diameter of the chordae between papillary muscles and mitral leaflets; 0: none", AT(LeafletSettings, chordae_m)},
    {"leaflets", "annulus_mm", kMm, ranges::kAnnulus_mm, "diameter of the fibrous rings along the hinges of mitral and tricuspid leaflets; 0: none", AT(LeafletSettings, annulus_m)},
    {"leaflets", "annulus_db", kDb, ranges::kAnnulus_db, "backscatter of these rings across their fibres, relative to the leaflets' medium", AT(LeafletSettings, annulus_db)},

    {"artefacts", "dropout", kNone, kAny, "loss of contact towards the sector's edges", AT(ArtefactSettings, dropout)},
    {"artefacts", "dropout_db", kDb, ranges::kLoss_db, "loss on the outermost lines", AT(ArtefactSettings, dropout_db)},
    {"artefacts", "acoustic_window", kNone, kAny, "ribs shade part of the aperture", AT(ArtefactSettings, acoustic_window)},
    {"artefacts", "window_width_mm", kMm, ranges::kArtefactLength_mm, "width of the gap between the ribs", AT(ArtefactSettings, window_width_m)},
    {"artefacts", "window_offset_mm", kMm, ranges::kWindowOffset_mm, "middle of that gap, along probe.lateral", AT(ArtefactSettings, window_offset_m)},
    {"artefacts", "window_depth_mm", kMm, ranges::kArtefactLength_mm, "depth of the ribs, from the face", AT(ArtefactSettings, window_depth_m)},
    {"artefacts", "window_shadow_db", kDb, ranges::kLoss_db, "two-way loss in a complete shadow", AT(ArtefactSettings, window_shadow_db)},
    {"artefacts", "shading", kNone, kAny, "patches of the chest wall weaken parts of the aperture", AT(ArtefactSettings, shading)},
    {"artefacts", "shading_db", kDb, ranges::kHeterogeneity_db, "standard deviation of one passage through the patches", AT(ArtefactSettings, shading_db)},
    {"artefacts", "shading_grain_mm", kMm, ranges::kArtefactLength_mm, "size of a patch", AT(ArtefactSettings, shading_grain_m)},
    {"artefacts", "shading_depth_mm", kMm, ranges::kArtefactLength_mm, "depth of the patches, from the face", AT(ArtefactSettings, shading_depth_m)},
    {"artefacts", "shading_seed", kNone, kSeed, "seed of the patches", AT(ArtefactSettings, shading_seed)},
    {"artefacts", "lung", kNone, kAny, "reverberations beyond the surface of air-filled media: mirrored tissue that fades", AT(ArtefactSettings, lung)},
    {"artefacts", "lung_db", kDb, ranges::kLevel_db, "level at that surface relative to the tissue in front of it", AT(ArtefactSettings, lung_db)},
    {"artefacts", "lung_length_mm", kMm, ranges::kArtefactLength_mm, "length over which these reverberations fall to 1/e", AT(ArtefactSettings, lung_length_m)},
    {"artefacts", "haze", kNone, kAny, "aberration and multiple scattering: a two-sided exponential across the lines", AT(ArtefactSettings, haze)},
    {"artefacts", "haze_db", kDb, ranges::kLevel_db, "level relative to the echoes that the haze spreads", AT(ArtefactSettings, haze_db)},
    {"artefacts", "haze_width_deg", kDeg, ranges::kArtefactWidth_deg, "angle over which the haze falls to 1/e; for linear probes, as an arc at the middle depth", AT(ArtefactSettings, haze_width_rad)},
    {"artefacts", "reverberation", kNone, kAny, "a tail behind every echo", AT(ArtefactSettings, reverberation)},
    {"artefacts", "reverberation_db", kDb, ranges::kLevel_db, "level relative to the echo", AT(ArtefactSettings, reverberation_db)},
    {"artefacts", "reverberation_length_mm", kMm, ranges::kArtefactLength_mm, "length over which the tail falls to 1/e", AT(ArtefactSettings, reverberation_length_m)},
    {"artefacts", "clutter", kNone, kAny, "clutter in the near field", AT(ArtefactSettings, clutter)},
    {"artefacts", "clutter_db", kDb, ranges::kLevel_db, "level relative to white, at the face", AT(ArtefactSettings, clutter_db)},
    {"artefacts", "clutter_parasternal_db", kDb, ranges::kLevel_db, "added to clutter_db, times the fourth power of the sine of the angle between beam and long axis of the left ventricle", AT(ArtefactSettings, clutter_parasternal_db)},
    {"artefacts", "clutter_length_mm", kMm, ranges::kArtefactLength_mm, "depth over which the clutter falls to 1/e", AT(ArtefactSettings, clutter_length_m)},
    {"artefacts", "clutter_width_deg", kDeg, ranges::kArtefactWidth_deg, "angular size of the clutter's grain, full width at half maximum", AT(ArtefactSettings, clutter_width_rad)},
    {"artefacts", "clutter_time_ms", kMs, kTimes_ms, "renewal time of the clutter; 0: never renewed", AT(ArtefactSettings, clutter_time_s)},
    {"artefacts", "clutter_seed", kNone, kSeed, "seed of the clutter", AT(ArtefactSettings, clutter_seed)},
    {"artefacts", "noise", kNone, kAny, "receiver noise, which the time gain amplifies", AT(ArtefactSettings, noise)},
    {"artefacts", "noise_db", kDb, ranges::kLevel_db, "level relative to white, where the gain is largest", AT(ArtefactSettings, noise_db)},
    {"artefacts", "noise_seed", kNone, kSeed, "seed of the noise", AT(ArtefactSettings, noise_seed)},
    {"artefacts", "persistence", kNone, ranges::kPersistence, "weight of each frame relative to the next one", AT(ArtefactSettings, persistence)},

    {"truth", "write", kNone, kAny, "list of file kinds to write into truth/", kTruths},
    {"truth", "labels", kNone, kLabel, "label numbers by structure or role; if left out, closed structures are numbered from 1 in scene order", kByHand},
    {"truth", "papillary", kNone, kAny, "class of the papillary muscles in the label pictures", kPapillary},
    {"truth", "tracks", kNone, kTracks, "number of material points", AT(TruthSettings, track_count)},

    {"signal", "look", kNone, kAny, "selects the defaults of [signal], [trabeculae], [leaflets], [speckle], [artefacts] and accuracy.elevation_slices; keys in the scene override them", AT(SignalSettings, look)},
    {"signal", "quality", kNone, kAny, "strength of the artefacts in the looks of scanners", AT(SignalSettings, quality), kOptional, kWithQuality},
    {"signal", "tgc", kNone, kAny, "time gain: perfect compensates each path's attenuation, mean the beat's mean at each depth, nominal that of soft tissue", AT(SignalSettings, tgc)},
    {"signal", "tgc_nominal_db_cm_mhz", kNominalGain, ranges::kNominalGain_db_cm_mhz, "attenuation that the nominal gain compensates", AT(SignalSettings, nominal_gain_np_per_m_hz), kOptional, kWithNominal},
    {"signal", "tgc_table_mm_db", kNone, kAny, "pairs of depth and gain", kByHand, kAlways, kWithTable},
    {"signal", "near_gain_db", kDb, ranges::kPictureGain_db, "gain added at the face, falling linearly in dB to 0 at near_gain_depth_mm", AT(SignalSettings, near_gain_db)},
    {"signal", "near_gain_depth_mm", kMm, ranges::kArtefactLength_mm, "depth from which the near field's gain is 0", AT(SignalSettings, near_gain_depth_m)},
    {"signal", "spread", kNone, kAny, "whether the picture compensates the factor 1/l^2 of backscatter", AT(SignalSettings, spread)},
    {"signal", "beam_width", kNone, kAny, "focused: by aperture, frequency and focus; profile: the sampled two-way beam with its side lobes", AT(SignalSettings, beam_width)},
    {"signal", "beam_width_mm", kMm, ranges::kExtent_mm, "width of a fixed beam", AT(SignalSettings, beam_width_m), kAlways, kWithFixed},
    {"signal", "pulse_cycles", kNone, kPulse, "length of the pulse in cycles; axial average over half of it; 0: one sample", AT(SignalSettings, pulse_cycles)},
    {"signal", "dynamic_range_db", kDb, ranges::kDynamicRange_db, "range from black to white", AT(SignalSettings, dynamic_range_db)},
    {"signal", "reference_percentile", kNone, kPercentileRange, "white as a percentile over the loop's frames, near field excluded; if left out, white follows the heart muscle", kPercentile, kFound, kWithPercentile},
    {"signal", "reference_intensity", kNone, ranges::kReferenceIntensity, "white as an intensity relative to I_S", AT(SignalSettings, reference_intensity)},
    {"signal", "gain_db", kDb, ranges::kPictureGain_db, "gain of the picture; lowers the intensity of white", AT(SignalSettings, gain_db)},
    {"signal", "examiner_gain_db", kDb, ranges::kPictureGain_db, "added to gain_db: how far the examiner changes the gain of a look", AT(SignalSettings, examiner_gain_db)},
    {"signal", "interface_gain_db", kDb, ranges::kPictureGain_db, "gain of interface echoes relative to tissue, in the picture only", AT(SignalSettings, interface_gain_db)},
    {"signal", "interface_limit_db", kDb, ranges::kLevel_db, "limits interface echoes E to E / (1 + E / limit) in the picture; relative to I_S; no limit if left out", AT(SignalSettings, interface_limit_db)},
    {"signal", "grey_gamma", kNone, ranges::kGamma, "grey = c^gamma; c is the position in the dynamic range after toe and shoulder", AT(SignalSettings, grey_gamma)},
    {"signal", "grey_toe", kNone, ranges::kGreyToe, "lowest fraction of the dynamic range that is black", AT(SignalSettings, grey_toe)},
    {"signal", "grey_shoulder", kNone, ranges::kGreyShoulder, "highest fraction of the dynamic range, over which the slope falls to 0 at white", AT(SignalSettings, grey_shoulder)},
    {"signal", "harmonic", kNone, kAny, "second-harmonic imaging: sent at half of probe.frequency_mhz; for beam_width = \"profile\"", AT(SignalSettings, harmonic)},
    {"signal", "downshift", kNone, kAny, "attenuation lowers the centre frequency with depth, which widens beam and speckle cells; for beam_width = \"profile\"", AT(SignalSettings, downshift)},
    {"signal", "receive_f_number", kNone, ranges::kFNumber, "near the face the receiving aperture is depth / receive_f_number wide, at least a quarter of probe.aperture_mm, which widens beam and speckle cells; 0: the whole aperture; for beam_width = \"profile\"", AT(SignalSettings, receive_f_number)},
    {"signal", "edge_enhancement", kNone, ranges::kEdge, "unsharp masking of grey levels: factor of their difference from the mean", AT(SignalSettings, edge_enhancement)},
    {"signal", "edge_size_mm", kMm, ranges::kArtefactLength_mm, "size of the box of that mean", AT(SignalSettings, edge_size_m)},

    {"accuracy", "rays_per_beam", kNone, kRays, "2 or more: average over the beam's profile, also in Y; embree only", AT(AccuracySettings, rays_per_beam)},
    {"accuracy", "elevation_slices", kNone, kSlices, "1, 3 or 5 slices across the plane, averaged over the lens's beam; plane slice only", AT(AccuracySettings, elevation_slices)},
    {"accuracy", "tracer", kNone, kAny, "slice: plane slice of the meshes; embree: rays in space", AT(AccuracySettings, tracer)},
    {"accuracy", "interface_echo", kNone, kAny, "centre: sampled at each line; cell: integrated between lines, one ray per beam", AT(AccuracySettings, interface_echo)},
    {"accuracy", "normals", kNone, kAny, "facet: normals of the triangles; smooth: normals of the smooth surface that subdivision approaches; auto: smooth if rays bend", AT(AccuracySettings, normals)},
    {"accuracy", "refraction_tolerance_beam_widths", kNone, ranges::kToleranceLines, "with refraction auto, rays stay straight if echoes shift less than this in the worst part of the picture and beat", AT(AccuracySettings, refraction_tolerance_beam_widths)},
    {"accuracy", "rolling_lines", kNone, kLines, "with acquisition.rolling: number of neighbouring lines that share one instant", AT(AccuracySettings, rolling_lines)},
    {"accuracy", "motion_field_cells", kNone, kFieldCells, "cells of the tissue's motion field along the diagonal of the moving surfaces; fewer take less time to set up", AT(AccuracySettings, motion_field_cells)},
    {"accuracy", "tolerance_db", kDb, ranges::kTolerance_db, "render and plan select the cheapest lines, samples and accuracy within this RMS error of the finest picture", kByHand},

    {"output", "exr", kNone, kAny, "writes intensity/frame_*.exr", AT(OutputSettings, exr)},
    {"output", "channels", kNone, kAny, "list of channels of the EXR; those from structure.id on are ground truth, in mm and mm/s; velocity.beam: towards the probe, m/s", kChannels},
    {"output", "exr_compression", kNone, kAny, "pxr24 stores 24-bit floats, with errors up to 2^-16", AT(OutputSettings, exr_compression)},
    {"output", "exr_pixel", kNone, kAny, "half has errors up to 2^-11, down to 84 dB below the channel's largest value", AT(OutputSettings, exr_pixel)},
    {"output", "cine", kNone, kAny, "writes cine.avi", AT(OutputSettings, cine)},
    {"output", "codec", kNone, kAny, "codec of cine.avi and cine.dcm; ffv1 is lossless, and makes cine.dcm uncompressed RGB", AT(OutputSettings, codec)},
    {"output", "jpeg_quality", kNone, kQuality, "quality of codec mjpg", AT(OutputSettings, jpeg_quality)},
    {"output", "png", kNone, kAny, "writes png/frame_*.png", AT(OutputSettings, png)},
    {"output", "dicom", kNone, kAny, "writes cine.dcm, a DICOM Ultrasound Multi-frame file", AT(OutputSettings, dicom)},
    {"output", "report", kNone, kAny, "writes report.html, the run on one page", AT(OutputSettings, report)},
    {"output", "volumes", kNone, kAny, "writes volumes.csv: chamber volumes and strain in each frame", AT(OutputSettings, volumes)},
    {"output", "width", kPx, kPixels, "width of the picture", AT(OutputSettings, width)},
    {"output", "height", kPx, kPixels, "height of the picture", AT(OutputSettings, height)},
    {"output", "ecg", kNone, kAny, "draws the ECG below the picture", AT(OutputSettings, ecg)},
    {"output", "depth_ticks", kNone, kAny, "draws depth ticks beside the picture", AT(OutputSettings, depth_ticks)},
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
