// Ground truth of a recorded heart, for tests of algorithms.

#include "motion/heart/heart_truth.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

namespace echocine::heart {

namespace {

using Json = nlohmann::ordered_json;

double rounded(double value, double step) {
  return std::round(value / step) * step;
}
double inMillilitres(double m3) {
  return rounded(m3 * 1e6, 1e-4);
}
double inMillimetres(double m) {
  return rounded(m * 1e3, 1e-4);
}
double inDegrees(double rad) {
  return rounded(rad * 180 / std::numbers::pi, 1e-4);
}

Json parametersJson(const Parameters& parameters) {
  Json json;
  for (const Dial& dial : dials()) {
    const auto value = dial.get(parameters);
    json[dial.key] = value ? Json{{"value", *value}, {"unit", dial.unit}} : Json();
  }
  Json segments = Json::array();
  for (const Segment& segment : parameters.segments)
    segments.push_back({{"amplitude", segment.amplitude}, {"delay_ms", segment.delay_s * 1e3}});
  json["segments"] = segments;
  json["rule"] = parameters.volumes_rule ? "volumes" : "segments";
  return json;
}

Json timingJson(const Cycle& cycle) {
  const PhaseDurations& d = cycle.durations();
  const CycleEvents& e = cycle.events();
  const auto ms = [](double seconds) { return rounded(seconds * 1e3, 1e-3); };
  return {{"durations_ms",
           {{"isovolumic_contraction", ms(d.isovolumic_contraction_s)},
            {"ejection", ms(d.ejection_s)},
            {"isovolumic_relaxation", ms(d.isovolumic_relaxation_s)},
            {"rapid_filling", ms(d.rapid_filling_s)},
            {"diastasis", ms(d.diastasis_s)},
            {"atrial_kick", ms(d.atrial_kick_s)}}},
          {"event_phases",
           {{"mitral_closes", e.mitral_closes},
            {"aortic_opens", e.aortic_opens},
            {"aortic_closes", e.aortic_closes},
            {"mitral_opens", e.mitral_opens},
            {"diastasis_begins", e.diastasis_begins},
            {"atrial_kick_begins", e.atrial_kick_begins}}}};
}

Json leftVentricleJson(const Recording& recording) {
  const auto& cavity = recording.part("lv_cavity").volume_m3;
  const auto& outer = recording.part("lv_wall").volume_m3;
  const std::size_t es = recording.end_systole;
  const Landmarks &at_ed = recording.places[0], &at_es = recording.places[es];
  const auto thickness = [](const Landmarks& places) {
    Json list = Json::array();
    for (const double m : places.wall_thickness_m) list.push_back(inMillimetres(m));
    return list;
  };
  return {{"edv_ml", inMillilitres(cavity[0])},
          {"esv_ml", inMillilitres(cavity[es])},
          {"ejection_fraction", rounded(1 - cavity[es] / cavity[0], 1e-5)},
          {"length_mm",
           {{"end_diastole", inMillimetres(at_ed.apex.z - at_ed.mitral.z)},
            {"end_systole", inMillimetres(at_es.apex.z - at_es.mitral.z)}}},
          {"mapse_mm", inMillimetres(length(at_es.mitral - at_ed.mitral))},
          {"tapse_mm", inMillimetres(at_es.tricuspid_lateral.z - at_ed.tricuspid_lateral.z)},
          {"twist_deg", inDegrees(at_es.twist_rad - at_ed.twist_rad)},
          {"wall_volume_ml",
           {{"end_diastole", inMillilitres(outer[0] - cavity[0])},
            {"end_systole", inMillilitres(outer[es] - cavity[es])}}},
          {"wall_thickness_mm_by_segment",
           {{"end_diastole", thickness(at_ed)}, {"end_systole", thickness(at_es)}}}};
}

Json placeJson(Vec3d p) {
  return {inMillimetres(p.x), inMillimetres(p.y), inMillimetres(p.z)};
}

Json keyframesJson(const ParametricHeart& heart, const Recording& recording) {
  Json list = Json::array();
  for (std::size_t k = 0; k < recording.phases.size(); ++k) {
    Json volumes;
    for (const RecordedPart& part : recording.parts)
      if (part.volume_m3.size() > 1) volumes[part.kind.name] = inMillilitres(part.volume_m3[k]);
    const Landmarks& places = recording.places[k];
    const State state = heart.cycle().at(recording.phases[k]);
    list.push_back({{"index", k},
                    {"phase", recording.phases[k]},
                    {"volumes_ml", volumes},
                    {"valve_openings",
                     {{"mitral", rounded(state.mitral, 1e-4)},
                      {"tricuspid", rounded(state.tricuspid, 1e-4)},
                      {"aortic", rounded(state.aortic, 1e-4)},
                      {"pulmonary", rounded(state.pulmonary, 1e-4)}}},
                    {"places_mm",
                     {{"lv_apex", placeJson(places.apex)},
                      {"mitral_ring", placeJson(places.mitral)},
                      {"tricuspid_ring", placeJson(places.tricuspid)},
                      {"aortic_ring", placeJson(places.aortic)},
                      {"pulmonary_ring", placeJson(places.pulmonary)}}}});
  }
  return list;
}

}  // namespace

std::string truthText(const ParametricHeart& heart, const Recording& recording) {
  const Json json{
      {"version", ECHOCINE_VERSION},
      {"coordinates",
       "mm; origin at the mitral ring at end-diastole, z to the apex, x lateral, y anterior"},
      {"volumes",
       fmt::format("enclosed by the surfaces after {} levels of subdivision", Recording::kLevels)},
      {"parameters", parametersJson(heart.parameters())},
      {"timing", timingJson(heart.cycle())},
      {"end_systole_keyframe", recording.end_systole},
      {"end_systole_keyframe_phase", recording.phases[recording.end_systole]},
      {"left_ventricle", leftVentricleJson(recording)},
      {"keyframes", keyframesJson(heart, recording)}};
  return json.dump(1) + "\n";
}

}  // namespace echocine::heart
