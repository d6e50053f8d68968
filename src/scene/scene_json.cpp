#include "scene/scene_json.h"

#include <nlohmann/json.hpp>

#include "scene/names.h"
#include "scene/white_rule.h"

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

Json optionalJson(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

Json vectorJson(Vec3d v) {
  return Json::array({v.x, v.y, v.z});
}

Json probeJson(const Probe& p) {
  return {{"kind", nameOf(p.kind)},
          {"apex_m", vectorJson(p.pose.origin)},
          {"lateral", vectorJson(p.pose.x_axis)},
          {"elevation", vectorJson(p.pose.y_axis)},
          {"axis", vectorJson(p.pose.z_axis)},
          {"first_angle_rad", p.first_angle_rad},
          {"last_angle_rad", p.last_angle_rad},
          {"face_radius_m", p.face_radius_m},
          {"first_offset_m", p.first_offset_m},
          {"last_offset_m", p.last_offset_m},
          {"min_depth_m", p.min_depth_m},
          {"max_depth_m", p.max_depth_m},
          {"frequency_hz", p.frequency_hz},
          {"aperture_m", p.aperture_m},
          {"focus_m", p.focus_m},
          {"elevation_aperture_m", p.elevation_aperture_m},
          {"elevation_focus_m", p.elevation_focus_m},
          {"lines", p.lines},
          {"samples", p.samples}};
}

Json repairJson(const Repairs& r) {
  Json words = Json::array();
  if (r.weld) words.push_back("weld");
  if (r.drop_degenerate) words.push_back("drop-degenerate");
  if (r.orient) words.push_back("orient");
  if (r.split) words.push_back("split");
  if (r.fill_holes) words.push_back("fill-holes");
  return words;
}

// As a scene names it, from the scene's folder; an absolute path is nobody's business but its name.
std::string fileFrom(const std::filesystem::path& scene, const std::filesystem::path& file) {
  const std::filesystem::path from = file.lexically_relative(scene.parent_path());
  return from.empty() ? file.filename().string() : from.generic_string();
}

Json structuresJson(const Scene& scene) {
  Json list = Json::array();
  for (const Structure& s : scene.structures) {
    Json keyframes = Json::array();
    for (const Keyframe& k : s.keyframes) {
      Json files = Json::array();
      for (const auto& file : k.files) files.push_back(fileFrom(scene.file, file));
      keyframes.push_back({{"files", files}, {"phase", k.phase}});
    }
    list.push_back({{"name", s.name},
                    {"role", nameOf(s.role)},
                    {"medium", scene.medium(s.medium).name},
                    {"membrane", s.membrane},
                    {"priority", s.priority},
                    {"reflection_gain", s.reflection_gain},
                    {"reflection_exponent", s.reflection_exponent},
                    {"coherent_share", s.coherent_share},
                    {"repair", repairJson(s.repair)},
                    {"keyframes", keyframes}});
  }
  return list;
}

Json effectsJson(const EffectSwitches& switches) {
  Json json = Json::object();
  for (const EffectSwitch& s : kEffectSwitches) json[nameOf(s.effect)] = nameOf(switches.*s.wanted);
  return json;
}

Json signalJson(const SignalSettings& s) {
  Json tgc_table = Json::array();
  for (const auto& [depth_m, gain_db] : s.tgc_table) tgc_table.push_back({depth_m, gain_db});
  return {{"look", nameOf(s.look)},
          {"quality", nameOf(s.quality)},
          {"tgc", nameOf(s.tgc)},
          {"tgc_table_m_db", tgc_table},
          {"nominal_gain_np_per_m_hz", s.nominal_gain_np_per_m_hz},
          {"spread", nameOf(s.spread)},
          {"beam_width", nameOf(s.beam_width)},
          {"beam_width_m", s.beam_width_m},
          {"pulse_cycles", s.pulse_cycles},
          {"dynamic_range_db", s.dynamic_range_db},
          {"reference_intensity", optionalJson(s.reference_intensity)},
          // null: white goes by the heart's muscle
          {"reference_percentile",
           s.reference_percentile == kWhiteByMuscle ? Json() : Json(s.reference_percentile)},
          {"gain_db", s.gain_db},
          {"interface_gain_db", s.interface_gain_db},
          {"interface_limit_db", optionalJson(s.interface_limit_db)},
          {"grey_gamma", s.grey_gamma}};
}

Json speckleJson(const SpeckleSettings& s) {
  return {{"on", s.on},
          {"seed", s.seed},
          {"per_cell", s.per_cell},
          {"smoothing_m", s.smoothing_m},
          {"tissue_time_s", s.tissue_time_s},
          {"blood_time_s", s.blood_time_s},
          {"heterogeneity_db", s.heterogeneity_db},
          {"heterogeneity_fine_m", s.heterogeneity_fine_m},
          {"heterogeneity_layer_m", s.heterogeneity_layer_m},
          {"heterogeneity_coarse_m", s.heterogeneity_coarse_m},
          {"heterogeneity_seed", s.heterogeneity_seed},
          {"anisotropy_db", s.anisotropy_db},
          {"helix_angle_rad", s.helix_angle_rad}};
}

Json trabeculaeJson(const TrabeculaeSettings& t) {
  return {{"height_m", t.deviation_m}, {"scale_m", t.scale_m}, {"seed", t.seed}};
}

Json artefactsJson(const ArtefactSettings& a) {
  return {{"dropout", a.dropout},
          {"dropout_db", a.dropout_db},
          {"acoustic_window", a.acoustic_window},
          {"window_width_m", a.window_width_m},
          {"window_offset_m", a.window_offset_m},
          {"window_depth_m", a.window_depth_m},
          {"window_shadow_db", a.window_shadow_db},
          {"haze", a.haze},
          {"haze_db", a.haze_db},
          {"haze_width_rad", a.haze_width_rad},
          {"reverberation", a.reverberation},
          {"reverberation_db", a.reverberation_db},
          {"reverberation_length_m", a.reverberation_length_m},
          {"clutter", a.clutter},
          {"clutter_db", a.clutter_db},
          {"clutter_length_m", a.clutter_length_m},
          {"clutter_width_rad", a.clutter_width_rad},
          {"clutter_seed", a.clutter_seed},
          {"noise", a.noise},
          {"noise_db", a.noise_db},
          {"noise_seed", a.noise_seed},
          {"persistence", a.persistence}};
}

Json outputJson(const OutputSettings& o) {
  Json channels = Json::array();
  for (const Channel c : o.channels) channels.push_back(channelName(c));
  return {{"exr", o.exr},
          {"cine", o.cine},
          {"png", o.png},
          {"report", o.report},
          {"channels", channels},
          {"exr_compression", nameOf(o.exr_compression)},
          {"exr_pixel", nameOf(o.exr_pixel)},
          {"codec", nameOf(o.codec)},
          {"jpeg_quality", o.jpeg_quality},
          {"width", o.width},
          {"height", o.height},
          {"ecg", o.ecg},
          {"depth_ticks", o.depth_ticks}};
}

Json truthJson(const TruthSettings& t) {
  Json numbers = Json::object();
  for (const auto& [name, number] : t.label_numbers) numbers[name] = number;
  return {{"labels", t.labels},          {"contours", t.contours},
          {"tracks", t.tracks},          {"function", t.function},
          {"label_numbers", numbers},    {"papillary_in_cavity", t.papillary_in_cavity},
          {"track_count", t.track_count}};
}

}  // namespace

Json mediaJson(const Scene& scene) {
  Json media = Json::object();
  for (const Medium& m : scene.media)
    media[m.name] = {{"Z", m.impedance_kg_m2_s},
                     {"c", m.sound_speed_m_s},
                     {"alpha_np_per_m", m.attenuation_np_per_m},
                     {"eta_b_per_m_sr", m.backscatter_per_m_sr}};
  return media;
}

Json sceneJson(const Scene& scene) {
  Json json = {
      {"background", scene.medium(scene.background).name},
      {"unit_volume_m3", scene.unit_volume_m3},
      {"probe", probeJson(scene.probe)},
      {"acquisition",
       {{"heart_rate_hz", scene.acquisition.heart_rate_hz},
        {"frame_rate_hz", scene.acquisition.frame_rate_hz},
        {"beats", scene.acquisition.beats},
        {"time_warp", nameOf(scene.acquisition.time_warp)},
        {"rr_variability", scene.acquisition.rr_variability},
        {"seed", scene.acquisition.seed},
        {"rolling", scene.acquisition.rolling},
        {"rolling_share", scene.acquisition.rolling_share}}},
      {"motion",
       {{"mesh_unit_m", scene.motion.mesh_unit_m},
        {"interpolation", nameOf(scene.motion.interpolation)},
        {"subdivision", scene.motion.subdivision},
        {"keyframe_heart_rate_hz", optionalJson(scene.motion.keyframe_heart_rate_hz)},
        {"end_systole_phase", optionalJson(scene.motion.end_systole_phase)}}},
      {"structures", structuresJson(scene)},
      {"effects", effectsJson(scene.effects)},
      {"signal", signalJson(scene.signal)},
      {"accuracy",
       {{"rays_per_beam", scene.accuracy.rays_per_beam},
        {"tracer", nameOf(scene.accuracy.tracer)},
        {"interface_echo", nameOf(scene.accuracy.interface_echo)},
        {"normals", nameOf(scene.accuracy.normals)},
        {"refraction_tolerance_beam_widths", scene.accuracy.refraction_tolerance_beam_widths},
        {"rolling_lines", scene.accuracy.rolling_lines}}},
      {"output", outputJson(scene.output)},
      {"truth", truthJson(scene.truth)}};
  // Meshes that lie as their files have them are the same scene as before they could be moved.
  if (scene.motion.mesh_scale != 1) json["motion"]["mesh_scale"] = scene.motion.mesh_scale;
  if (const Vec3d m = scene.motion.mesh_offset_m; m != Vec3d{})
    json["motion"]["mesh_offset_m"] = {m.x, m.y, m.z};
  if (scene.accuracy.elevation_slices > 1)
    json["accuracy"]["elevation_slices"] = scene.accuracy.elevation_slices;
  // A picture without speckle is the same file as before there was any.
  if (scene.trabeculae.deviation_m > 0) json["trabeculae"] = trabeculaeJson(scene.trabeculae);
  if (scene.speckle.on) json["speckle"] = speckleJson(scene.speckle);
  json["artefacts"] = artefactsJson(scene.artefacts);
  return json;
}

}  // namespace echocine
