#include "scene/scene_json.h"

#include <nlohmann/json.hpp>

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

template <typename E>
const char* nameOf(E value, std::initializer_list<const char*> names) {
  return names.begin()[static_cast<std::size_t>(value)];
}

Json optionalJson(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

Json vectorJson(Vec3d v) {
  return Json::array({v.x, v.y, v.z});
}

Json probeJson(const Probe& p) {
  return {{"kind", nameOf(p.kind, {"phased", "curvilinear", "linear"})},
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
  if (r.fill_holes) words.push_back("fill-holes");
  return words;
}

Json structuresJson(const Scene& scene) {
  Json list = Json::array();
  for (const Structure& s : scene.structures) {
    Json keyframes = Json::array();
    for (const Keyframe& k : s.keyframes) {
      Json files = Json::array();
      for (const auto& file : k.files) files.push_back(file.filename().string());
      keyframes.push_back({{"files", files}, {"phase", k.phase}});
    }
    list.push_back({{"name", s.name},
                    {"medium", scene.medium(s.medium).name},
                    {"membrane", s.membrane},
                    {"priority", s.priority},
                    {"reflection_gain", s.reflection_gain},
                    {"reflection_exponent", s.reflection_exponent},
                    {"repair", repairJson(s.repair)},
                    {"keyframes", keyframes}});
  }
  return list;
}

Json effectsJson(const EffectSwitches& e) {
  const auto name = [](Switch s) { return nameOf(s, {"auto", "on", "off"}); };
  return {{"reflection", name(e.reflection)},
          {"lobe", name(e.lobe)},
          {"transmission_loss", name(e.transmission_loss)},
          {"refraction", name(e.refraction)},
          {"attenuation", name(e.attenuation)},
          {"backscatter", name(e.backscatter)},
          {"spread", name(e.spread)},
          {"beam_width", name(e.beam_width)},
          {"elevation", name(e.elevation)},
          {"travel_time", name(e.travel_time)}};
}

Json signalJson(const SignalSettings& s) {
  Json tgc_table = Json::array();
  for (const auto& [depth_m, gain_db] : s.tgc_table) tgc_table.push_back({depth_m, gain_db});
  return {{"tgc", nameOf(s.tgc, {"perfect", "table", "none"})},
          {"tgc_table_m_db", tgc_table},
          {"spread", nameOf(s.spread, {"compensate", "keep"})},
          {"beam_width", nameOf(s.beam_width, {"focused", "fixed", "none"})},
          {"beam_width_m", s.beam_width_m},
          {"pulse_cycles", s.pulse_cycles},
          {"dynamic_range_db", s.dynamic_range_db},
          {"reference_intensity", optionalJson(s.reference_intensity)},
          {"reference_percentile", s.reference_percentile},
          {"grey_gamma", s.grey_gamma}};
}

Json speckleJson(const SpeckleSettings& s) {
  return {{"on", s.on},
          {"seed", s.seed},
          {"per_cell", s.per_cell},
          {"smoothing_m", s.smoothing_m},
          {"tissue_time_s", s.tissue_time_s},
          {"blood_time_s", s.blood_time_s}};
}

Json outputJson(const OutputSettings& o) {
  Json channels = Json::array();
  for (const Channel c : o.channels) channels.push_back(channelName(c));
  return {{"exr", o.exr},
          {"cine", o.cine},
          {"png", o.png},
          {"report", o.report},
          {"channels", channels},
          {"exr_compression",
           nameOf(o.exr_compression, {"none", "rle", "zips", "zip", "piz", "pxr24"})},
          {"exr_pixel", nameOf(o.exr_pixel, {"float", "half"})},
          {"codec", nameOf(o.codec, {"mjpg", "ffv1"})},
          {"jpeg_quality", o.jpeg_quality},
          {"width", o.width},
          {"height", o.height},
          {"ecg", o.ecg},
          {"depth_ticks", o.depth_ticks}};
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
        {"time_warp", nameOf(scene.acquisition.time_warp, {"auto", "uniform", "systole"})},
        {"rr_variability", scene.acquisition.rr_variability},
        {"seed", scene.acquisition.seed}}},
      {"motion",
       {{"mesh_unit_m", scene.motion.mesh_unit_m},
        {"interpolation",
         nameOf(scene.motion.interpolation, {"linear", "catmull-rom", "spline", "fourier"})},
        {"subdivision", scene.motion.subdivision},
        {"keyframe_heart_rate_hz", optionalJson(scene.motion.keyframe_heart_rate_hz)},
        {"end_systole_phase", optionalJson(scene.motion.end_systole_phase)}}},
      {"structures", structuresJson(scene)},
      {"effects", effectsJson(scene.effects)},
      {"signal", signalJson(scene.signal)},
      {"accuracy",
       {{"rays_per_beam", scene.accuracy.rays_per_beam},
        {"tracer", nameOf(scene.accuracy.tracer, {"auto", "slice", "embree"})},
        {"interface_echo", nameOf(scene.accuracy.interface_echo, {"auto", "centre", "cell"})},
        {"normals", nameOf(scene.accuracy.normals, {"facet", "smooth"})},
        {"refraction_tolerance_lines", scene.accuracy.refraction_tolerance_lines}}},
      {"output", outputJson(scene.output)}};
  // A picture without speckle is the same file as before there was any.
  if (scene.speckle.on) json["speckle"] = speckleJson(scene.speckle);
  return json;
}

}  // namespace echocine
