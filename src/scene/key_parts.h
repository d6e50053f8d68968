#pragma once
// Parts of the rows of the table of keys: units, ranges, conditions, and fields of keys that are
// not single members. Included by scene_keys.cpp only.

#include <limits>
#include <string>

#include "core/units.h"
#include "scene/elevation_slices.h"
#include "scene/ranges.h"
#include "scene/scene_keys.h"
#include "scene/view_names.h"
#include "scene/white_rule.h"

namespace echocine::key_parts {

#define UNIT(symbol, si_of_file, file_of_si)               \
  {                                                        \
    symbol, [](double v) -> double { return si_of_file; }, \
        [](double v) -> double { return file_of_si; }      \
  }

inline constexpr KeyUnit kNone UNIT("", v, v);
inline constexpr KeyUnit kMm UNIT("mm", metresFromMillimetres(v), millimetresFromMetres(v));
inline constexpr KeyUnit kUm UNIT("um", metresFromMicrometres(v), v * 1e6);
inline constexpr KeyUnit kCm3 UNIT("cm3", cubicMetresFromCubicCentimetres(v),
                                   millilitresFromCubicMetres(v));
inline constexpr KeyUnit kDeg UNIT("deg", radiansFromDegrees(v), degreesFromRadians(v));
inline constexpr KeyUnit kMs UNIT("ms", 1e-3 * v, 1e3 * v);
inline constexpr KeyUnit kBpm UNIT("beats/min", hertzFromBeatsPerMinute(v), v * 60);
inline constexpr KeyUnit kHz UNIT("Hz", v, v);
inline constexpr KeyUnit kMhz UNIT("MHz", hertzFromMegahertz(v), v * 1e-6);
inline constexpr KeyUnit kDb UNIT("dB", v, v);
inline constexpr KeyUnit kPx UNIT("pixels", v, v);
// Np/m at 1 MHz, per Hz.
inline constexpr KeyUnit kNominalGain UNIT("dB/(cm MHz)", nepersPerMetre(1, 1, 1e6) / 1e6 * v,
                                           v / (nepersPerMetre(1, 1, 1e6) / 1e6));
inline constexpr KeyUnit kAttenuation UNIT("dB/(cm MHz^b)", v, v);
inline constexpr KeyUnit kDensity UNIT("kg/m3", v, v);
inline constexpr KeyUnit kSpeed UNIT("m/s", v, v);
inline constexpr KeyUnit kScattering UNIT("1/(cm sr)", perMetreFromPerCentimetre(v),
                                          perCentimetreFromPerMetre(v));
inline constexpr KeyUnit kCompressibility UNIT("cm2/dyn", perPascalFromSquareCentimetrePerDyne(v),
                                               v / 10);
inline constexpr KeyUnit kMeshUnit UNIT("motion.mesh_unit", v, v);

inline constexpr double kIntMost = std::numeric_limits<int>::max();
inline constexpr NumberRange kAny{}, kSeed{.lo = 0, .hi = kIntMost}, kPixels{.lo = 16, .hi = 16384},
    kTimes_ms{.lo = 0, .hi = 1e9},
    kCoordinate{.lo = -ranges::kMostCoordinate, .hi = ranges::kMostCoordinate},
    kShift_mm{.lo = -ranges::kMostShift_mm, .hi = ranges::kMostShift_mm},
    kOffset_mm{.lo = -ranges::kMostOffset_mm, .hi = ranges::kMostOffset_mm},
    kPhase{.lo = 0, .hi = 1, .hi_open = true}, kLines{.lo = 1, .hi = ranges::kMostLines},
    kSamples{.lo = 1, .hi = 65536}, kFrequency_mhz{.lo = 0.1, .hi = 100},
    kFrameRate_hz{.lo = 0.1, .hi = 100000},
    kVariability{.lo = 0,
                 .hi = 0.3},  // three deviations leave a tenth of the mean beat. Our choice
    kSubdivision{.lo = 0, .hi = 8},
    // phaseDurations() yields 0.19 at 30 bpm to 0.55 at 160; wider by our choice.
    kEndSystole{.lo = 0.1, .hi = 0.8}, kPriority{.lo = -1000000, .hi = 1000000},
    kExponent{.lo = 0, .hi = 1000}, kAttenuationExponent{.lo = 0, .hi = 4},
    kShare{.lo = 0, .hi = 1},
    kPerCell{.lo = 0.1, .hi = 1000},  // statistics converge from 3 on. Our choice
    kSmoothing_mm{.lo = 0, .hi = 100}, kLabel{.lo = 1, .hi = 255}, kTracks{.lo = 1, .hi = 1000000},
    kPulse{.lo = 0, .hi = 1000}, kPercentileRange{.lo = 0, .hi = 100, .lo_open = true},
    kRays{.lo = 1, .hi = 4096},       // errors are then far below a picture's. Our choice
    kFieldCells{.lo = 12, .hi = 96},  // coarser, walls vanish; finer takes gigabytes
    kSlices{.lo = 1, .hi = kMostElevationSlices}, kQuality{.lo = 1, .hi = 100};

inline constexpr KeyNeed kAlways = KeyNeed::always, kUnlessView = KeyNeed::unless_view,
                         kFound = KeyNeed::found, kOptional = KeyNeed::none;
inline constexpr KeyField kByHand{};

#define WITH(text, condition)                                 \
  {                                                           \
    [](const KeyOwner& o) -> bool { return condition; }, text \
  }

inline constexpr KeyUse kWithView WITH("view", o.scene->view.has_value());
inline constexpr KeyUse kWithAngle WITH("kind = \"phased\" | \"curvilinear\"",
                                        o.scene->probe.isSector());
inline constexpr KeyUse kWithCurve WITH("kind = \"curvilinear\" | \"radial\"",
                                        layoutOf(o.scene->probe.kind).curved_face);
inline constexpr KeyUse kWithWidth WITH("kind = \"linear\"", !o.scene->probe.isFan());
inline constexpr KeyUse kClosed WITH("membrane = false: a membrane encloses nothing",
                                     !o.structure->membrane);
inline constexpr KeyUse kWithQuality WITH(
    "look = \"scanner\" | \"smooth\" | \"contrast\" | \"sharp\" | \"portable\" | "
    "\"faint\"",
    isScanner(o.scene->signal.look));
inline constexpr KeyUse kWithNominal WITH("tgc = \"nominal\"", o.scene->signal.tgc == Tgc::nominal);
inline constexpr KeyUse kWithTable WITH("tgc = \"table\"", o.scene->signal.tgc == Tgc::table);
inline constexpr KeyUse kWithFixed WITH("beam_width = \"fixed\"",
                                        o.scene->signal.beam_width == BeamWidth::fixed);
inline constexpr KeyUse kWithPercentile WITH("reference_intensity left out",
                                             !o.scene->signal.reference_intensity);

inline constexpr KeyField kSector{KeyKind::number, nullptr,
                                  [](const KeyOwner& o) -> KeyValue {
                                    return o.scene->probe.last_angle_rad -
                                           o.scene->probe.first_angle_rad;
                                  },
                                  [](const KeyOwner& o, const KeyValue& v) {
                                    o.scene->probe.first_angle_rad = -std::get<double>(v) / 2;
                                    o.scene->probe.last_angle_rad = std::get<double>(v) / 2;
                                  }};
inline constexpr KeyField kWidth{KeyKind::number, nullptr,
                                 [](const KeyOwner& o) -> KeyValue {
                                   return o.scene->probe.last_offset_m -
                                          o.scene->probe.first_offset_m;
                                 },
                                 [](const KeyOwner& o, const KeyValue& v) {
                                   o.scene->probe.first_offset_m = -std::get<double>(v) / 2;
                                   o.scene->probe.last_offset_m = std::get<double>(v) / 2;
                                 }};
inline constexpr KeyField kDepth{
    KeyKind::number, "max_depth_m",
    [](const KeyOwner& o) -> KeyValue {  // 0: not yet placed by the view
      const double depth_m = o.scene->probe.max_depth_m;
      return o.scene->view && depth_m == 0 ? KeyValue() : KeyValue(depth_m);
    },
    [](const KeyOwner& o, const KeyValue& v) { o.scene->probe.max_depth_m = std::get<double>(v); }};
inline constexpr KeyField kFocus{
    KeyKind::number, "focus_m",
    [](const KeyOwner& o) -> KeyValue {  // 0: half of a depth that is not yet known
      const double focus_m = o.scene->probe.focus_m;
      return o.scene->view && focus_m == 0 ? KeyValue() : KeyValue(focus_m);
    },
    [](const KeyOwner& o, const KeyValue& v) { o.scene->probe.focus_m = std::get<double>(v); }};
inline constexpr KeyField kMeshUnitField{
    KeyKind::word, nullptr,
    [](const KeyOwner& o) -> KeyValue {
      const double unit_m = o.scene->motion.mesh_unit_m;
      return std::string(unit_m == 1e-3 ? "mm" : unit_m == 1e-2 ? "cm" : "m");
    },
    [](const KeyOwner& o, const KeyValue& v) {
      const auto& name = std::get<std::string>(v);
      o.scene->motion.mesh_unit_m = name == "mm" ? 1e-3 : name == "cm" ? 1e-2 : 1.0;
    },
    [] {
      return std::vector<std::string_view>{"mm", "cm", "m"};
    }};
inline constexpr KeyField kPapillary{
    KeyKind::word, nullptr,
    [](const KeyOwner& o) -> KeyValue {
      return std::string(o.scene->truth.papillary_in_cavity ? "cavity" : "wall");
    },
    [](const KeyOwner& o, const KeyValue& v) {
      o.scene->truth.papillary_in_cavity = std::get<std::string>(v) == "cavity";
    },
    [] {
      return std::vector<std::string_view>{"wall", "cavity"};
    }};
inline constexpr KeyField kPercentile{
    KeyKind::number, "reference_percentile",
    [](const KeyOwner& o) -> KeyValue {  // none: white follows the heart's muscle
      const double percentile = o.scene->signal.reference_percentile;
      return percentile == kWhiteByMuscle ? KeyValue() : KeyValue(percentile);
    },
    [](const KeyOwner& o, const KeyValue& v) {
      o.scene->signal.reference_percentile = std::get<double>(v);
    }};

// Keys with their own reading code, accepting some words.
#define OF_WORDS(list)                                         \
  {                                                            \
    KeyKind::other, nullptr, nullptr, nullptr,                 \
        []() -> std::vector<std::string_view> { return list; } \
  }

inline std::vector<std::string_view> viewWords() {
  std::vector<std::string_view> words;
  for (const ViewName& name : viewNames()) words.emplace_back(name.key);
  return words;
}
inline std::vector<std::string_view> channelWords() {
  std::vector<std::string_view> words;
  for (const Channel c : kAllChannels) words.emplace_back(channelName(c));
  for (const Channel c : kTruthChannels) words.emplace_back(channelName(c));
  return words;
}
inline std::vector<std::string_view> repairWords() {
  return {"weld", "drop-degenerate", "orient", "split", "fill-holes"};
}
inline std::vector<std::string_view> truthWords() {
  return {"labels", "contours", "tracks", "function", "all"};
}
inline std::vector<std::string_view> lawWords() {
  return {"none", "fixed", "blood", "tissue"};
}
inline constexpr KeyField kViews OF_WORDS(viewWords());
inline constexpr KeyField kChannels OF_WORDS(channelWords());
inline constexpr KeyField kRepairs OF_WORDS(repairWords());
inline constexpr KeyField kTruths OF_WORDS(truthWords());
inline constexpr KeyField kLaws OF_WORDS(lawWords());

#undef OF_WORDS
#undef UNIT
#undef WITH

}  // namespace echocine::key_parts
