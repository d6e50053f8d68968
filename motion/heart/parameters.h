#pragma once
// The dials of the parametric heart.

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace echocine::heart {

inline constexpr int kSegments = 17;

// Wall motion of one of the 17 segments of the American Heart Association (Cerqueira et al.,
// Circulation 105, 539-542, 2002), which numbers them from 1.
struct Segment {
  double amplitude = 1;  // inward motion, healthy = 1: 0 akinetic, negative dyskinetic
  double delay_s = 0;    // relative to the other segments
};

// How the left ventricle's sections differ from those of the model, without a change of volume.
struct SectionShape {
  // Bow of the long axis at half length, towards the lateral and the anterior wall, over the
  // length.
  double bow_lateral = 0, bow_anterior = 0;
  // ln of the factor on the ratio of a section's diameters: septal-lateral / anterior-inferior, and
  // at 45 degrees to them, anterolateral / anteroseptal.
  double ellipticity = 0, ellipticity_45 = 0;
  // Factors on ratios of the wall's thickness: at 2/3 / at 1/3 of the length, lateral / septal,
  // anterior / inferior.
  double apical_thickness = 1, lateral_thickness = 1, anterior_thickness = 1;
};

// Defaults: a healthy adult, within the reference values of large cohorts.
struct Parameters {
  double heart_rate_bpm = 65;
  double edv_ml = 120, ejection_fraction = 0.60;  // of the left ventricle; 0..1
  double rv_edv_ml = 125;
  double la_volume_ml = 55, ra_volume_ml = 52;  // largest, at end-systole
  std::optional<double> lv_length_mm;  // mitral ring to apex at end-diastole; else from sphericity
  double sphericity = 0.60;            // short-axis diameter / length at end-diastole
  // Apical / basal diameter at end-diastole, at 2/3 and 1/3 of the length; else the outline's own.
  std::optional<double> conicity;
  double apical_motion = 1;  // inward motion / radius at 2/3 of the length, over that at 1/3
  SectionShape section;
  double wall_thickness_mm = 9;        // septum at end-diastole
  double mapse_mm = 13;                // systolic excursion of the mitral ring
  double twist_deg = 12;               // of the apex relative to the base at end-systole
  std::optional<double> atrial_share;  // fraction of the stroke volume filled by the atrial kick;
                                       // default by heart rate
  double mitral_opening = 1, tricuspid_opening = 1, aortic_opening = 1;  // 1: healthy
  double body_scale = 1;                                                 // scale of lengths
  std::array<Segment, kSegments> segments{};
  // true: the ejection fraction stays as dialled, and healthy segments compensate for akinetic
  // ones. false: each segment contracts by its own amplitude, which determines the ejection
  // fraction.
  bool volumes_rule = false;
};

// One dial: its name on the command line and in files, and its accepted range.
struct Dial {
  const char* key;  // such as "edv"
  const char* unit;
  double low, high;
  int power;  // power of the body scale in its default: 3 for volumes, 1 for lengths
  const char* meaning;
  void (*set)(Parameters&, double);
  std::optional<double> (*get)(const Parameters&);
  bool of_section = false;  // one of SectionShape
};
std::span<const Dial> dials();

// Whether a dial is one of SectionShape.
bool isSectionDial(std::string_view key);
// The same, or conicity or apical motion: hearts of version 0.1 lack these dials.
bool isShapeDial(std::string_view key);

// Largest share of its volume that the right ventricle ejects: it ejects what the left one does.
inline constexpr double kMostRightEjected = 0.85;

// Parameters from given dials, by key, with healthy segments. Other dials follow the given ones:
// lengths the body scale and volumes its cube; the right ventricle's volume the left one's;
// excursion of the ring and twist the ejection fraction. Precondition: every key is a dial's.
Parameters parametersFrom(const std::map<std::string, double>& given);

// Empty, or why one of the given dials would have no effect.
std::string contradictionIn(const std::map<std::string, double>& given);

// Empty if every dial is within its range and no detectable contradiction exists; otherwise the
// fault and the accepted values.
std::string faultOf(const Parameters& parameters);

}  // namespace echocine::heart
