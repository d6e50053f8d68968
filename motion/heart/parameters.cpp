#include "motion/heart/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "core/check.h"

namespace echocine::heart {
namespace {

#define ECHOCINE_DIAL(member)                            \
  [](Parameters& p, double value) { p.member = value; }, \
      [](const Parameters& p) { return std::optional<double>(p.member); }

// Ranges are our choice: from a small child's heart to the largest dilated one.
constexpr Dial kDials[] = {
    {"hr", "bpm", 30, 200, 0, "heart rate", ECHOCINE_DIAL(heart_rate_bpm)},
    {"edv", "mL", 5, 450, 3, "end-diastolic volume of the left ventricle", ECHOCINE_DIAL(edv_ml)},
    {"ef", "1", 0.05, 0.85, 0, "ejection fraction of the left ventricle",
     ECHOCINE_DIAL(ejection_fraction)},
    {"rv-edv", "mL", 5, 500, 3,
     "end-diastolic volume of the right ventricle; default: 1.04 times edv",
     ECHOCINE_DIAL(rv_edv_ml)},
    {"la-volume", "mL", 2, 250, 3, "largest volume of the left atrium",
     ECHOCINE_DIAL(la_volume_ml)},
    {"ra-volume", "mL", 2, 250, 3, "largest volume of the right atrium",
     ECHOCINE_DIAL(ra_volume_ml)},
    {"lv-length", "mm", 40, 140, 1,
     "length from mitral ring to apex at end-diastole; default: from edv and sphericity",
     ECHOCINE_DIAL(lv_length_mm)},
    {"sphericity", "1", 0.40, 0.90, 0, "short-axis diameter / length of the left ventricle",
     ECHOCINE_DIAL(sphericity)},
    {"conicity", "1", 0.50, 1.00, 0,
     "diameter of the left ventricle at 2/3 of its length / at 1/3; default: 0.71, that of the "
     "model",
     ECHOCINE_DIAL(conicity)},
    {"apical-motion", "1", 0.6, 1.6, 0,
     "inward motion / radius of the left ventricle at 2/3 of its length / the same at 1/3",
     ECHOCINE_DIAL(apical_motion)},
    {"bow-lateral", "1", -0.08, 0.08, 0,
     "bow of the left ventricle's axis towards the lateral wall at half length / length",
     ECHOCINE_DIAL(section.bow_lateral), true},
    {"bow-anterior", "1", -0.08, 0.08, 0, "the same towards the anterior wall",
     ECHOCINE_DIAL(section.bow_anterior), true},
    {"ellipticity", "1", -0.3, 0.3, 0,
     "ln of a factor on the septal-lateral / the anterior-inferior diameter of the left ventricle",
     ECHOCINE_DIAL(section.ellipticity), true},
    {"ellipticity-45", "1", -0.3, 0.3, 0,
     "the same for the two diameters at 45 degrees, anterolateral / anteroseptal",
     ECHOCINE_DIAL(section.ellipticity_45), true},
    {"apical-thickness", "1", 0.6, 1.6, 0,
     "factor on the wall's thickness at 2/3 of the length / at 1/3",
     ECHOCINE_DIAL(section.apical_thickness), true},
    {"lateral-thickness", "1", 0.6, 1.6, 0,
     "factor on the thickness of the lateral wall / the septum",
     ECHOCINE_DIAL(section.lateral_thickness), true},
    {"anterior-thickness", "1", 0.6, 1.6, 0,
     "factor on the thickness of the anterior wall / the inferior wall",
     ECHOCINE_DIAL(section.anterior_thickness), true},
    {"wall-thickness", "mm", 3, 20, 1, "thickness of the septum at end-diastole",
     ECHOCINE_DIAL(wall_thickness_mm)},
    {"mapse", "mm", 0, 30, 1, "systolic excursion of the mitral ring; default: proportional to ef",
     ECHOCINE_DIAL(mapse_mm)},
    {"twist", "deg", -10, 30, 0,
     "systolic rotation of the apex relative to the base; default: proportional to ef",
     ECHOCINE_DIAL(twist_deg)},
    {"atrial-share", "1", 0.05, 0.6, 0,
     "fraction of the stroke volume filled by the atrial kick; default: by heart rate",
     ECHOCINE_DIAL(atrial_share)},
    {"mitral-opening", "1", 0, 1, 0, "opening of the mitral valve: 0 stays closed, 1 normal",
     ECHOCINE_DIAL(mitral_opening)},
    {"tricuspid-opening", "1", 0, 1, 0, "opening of the tricuspid valve: 0 stays closed, 1 normal",
     ECHOCINE_DIAL(tricuspid_opening)},
    {"aortic-opening", "1", 0, 1, 0, "opening of the aortic valve: 0 stays closed, 1 normal",
     ECHOCINE_DIAL(aortic_opening)},
    {"body-scale", "1", 0.4, 1.5, 0, "scale of all dials that are not given",
     ECHOCINE_DIAL(body_scale)},
};

#undef ECHOCINE_DIAL

std::string outOfRange(std::string_view key, double value, double low, double high,
                       std::string_view unit) {
  return fmt::format("{} is {:g}; accepted are {:g} to {:g}{}{}", key, value, low, high,
                     unit == "1" ? "" : " ", unit == "1" ? "" : unit);
}

std::string segmentFault(const Parameters& parameters) {
  for (int s = 0; s < kSegments; ++s) {
    const Segment& segment = parameters.segments[s];
    if (!(segment.amplitude >= -0.5 && segment.amplitude <= 1.5))
      return outOfRange(fmt::format("amplitude of segment {}", s + 1), segment.amplitude, -0.5, 1.5,
                        "1");
    if (!(segment.delay_s >= 0 && segment.delay_s <= 0.2))
      return outOfRange(fmt::format("delay of segment {}", s + 1), segment.delay_s * 1e3, 0, 200,
                        "ms");
  }
  return {};
}

}  // namespace

std::span<const Dial> dials() {
  return kDials;
}

bool isSectionDial(std::string_view key) {
  return std::any_of(std::begin(kDials), std::end(kDials),
                     [&](const Dial& dial) { return dial.of_section && dial.key == key; });
}

bool isShapeDial(std::string_view key) {
  return key == "conicity" || key == "apical-motion" || isSectionDial(key);
}

Parameters parametersFrom(const std::map<std::string, double>& given) {
  Parameters parameters;
  const auto is_given = [&](const char* key) { return given.count(key) > 0; };
  const double scale = is_given("body-scale") ? given.at("body-scale") : 1;
  for (const Dial& dial : kDials)
    if (is_given(dial.key))
      dial.set(parameters, given.at(dial.key));
    else if (const auto value = dial.get(parameters))
      dial.set(parameters, *value * std::pow(scale, dial.power));
  const Parameters healthy;
  const double vigour = parameters.ejection_fraction / healthy.ejection_fraction;
  if (!is_given("mapse")) parameters.mapse_mm *= vigour;
  if (!is_given("twist")) parameters.twist_deg *= vigour;
  if (!is_given("rv-edv"))
    parameters.rv_edv_ml = healthy.rv_edv_ml / healthy.edv_ml * parameters.edv_ml;
  return parameters;
}

std::string contradictionIn(const std::map<std::string, double>& given) {
  return given.contains("lv-length") && given.contains("sphericity")
             ? "lv-length and sphericity both set the width of the cavity, accepted: one of them"
             : "";
}

std::string faultOf(const Parameters& parameters) {
  const Dial& scale = kDials[std::size(kDials) - 1];  // first: the others' defaults follow it
  if (!(parameters.body_scale >= scale.low && parameters.body_scale <= scale.high))
    return outOfRange(scale.key, parameters.body_scale, scale.low, scale.high, scale.unit);
  for (const Dial& dial : kDials)
    if (const auto value = dial.get(parameters);
        value && !(*value >= dial.low && *value <= dial.high))
      return outOfRange(dial.key, *value, dial.low, dial.high, dial.unit);
  if (std::string fault = segmentFault(parameters); !fault.empty()) return fault;
  const double stroke_ml = parameters.edv_ml * parameters.ejection_fraction;
  if (stroke_ml > kMostRightEjected * parameters.rv_edv_ml)
    return fmt::format(
        "edv and ef eject {:.4g} mL a beat, but the right ventricle's {:.4g} mL give {:.4g} at "
        "most: raise rv-edv to {:g} or lower ef",
        stroke_ml, parameters.rv_edv_ml, kMostRightEjected * parameters.rv_edv_ml,
        std::ceil(stroke_ml / kMostRightEjected));
  return {};
}

}  // namespace echocine::heart
