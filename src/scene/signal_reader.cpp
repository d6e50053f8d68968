#include "scene/signal_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/units.h"
#include "scene/looks.h"
#include "scene/ranges.h"
#include "scene/white_rule.h"

namespace echocine {

namespace {

// Keeps intensities within floats; scanners end at 100. Our choice.
constexpr double kMaxGainDb = 200;

int readSeed(TomlTable& table, std::string_view key, int fallback) {
  return table.integer(key, fallback, 0, std::numeric_limits<int>::max());
}

double readLength(TomlTable& table, std::string_view key, double fallback_m,
                  NumberRange range_mm = ranges::kArtefactLength_mm) {
  return metresFromMillimetres(table.number(key, millimetresFromMetres(fallback_m), range_mm));
}

double readAngle(TomlTable& table, std::string_view key, double fallback_rad,
                 NumberRange range_deg = ranges::kArtefactWidth_deg) {
  return radiansFromDegrees(table.number(key, degreesFromRadians(fallback_rad), range_deg));
}

void readTgcTable(TomlTable& table, SignalSettings& s) {
  if (s.tgc != Tgc::table) return table.unused("tgc_table_mm_db", "tgc = \"table\"");
  for (const auto& [depth_mm, gain_db] : table.pairs("tgc_table_mm_db")) {
    const double depth_m = metresFromMillimetres(depth_mm);
    if (!(depth_mm >= 0 && depth_mm <= ranges::kExtent_mm.hi))
      table.fail("tgc_table_mm_db", fmt::format("a depth is {} mm, accepted: 0 to {} mm", depth_mm,
                                                ranges::kExtent_mm.hi));
    if (std::abs(gain_db) > kMaxGainDb)
      table.fail("tgc_table_mm_db", fmt::format("a gain is {} dB, accepted: {} to {} dB", gain_db,
                                                -kMaxGainDb, kMaxGainDb));
    if (!s.tgc_table.empty() && depth_m <= s.tgc_table.back().first)
      table.fail("tgc_table_mm_db", "depths do not ascend, accepted: ascending depths");
    s.tgc_table.emplace_back(depth_m, gain_db);
  }
  if (s.tgc_table.empty())
    table.fail("tgc_table_mm_db", "is missing or empty, accepted: [[depth_mm, gain_db], ...]");
}

void readTgc(TomlTable& table, SignalSettings& s) {
  constexpr double kHz = 1e6;  // 1 MHz: Np/m there, per Hz
  constexpr std::string_view kNominal = "tgc_nominal_db_cm_mhz";
  s.tgc = table.choice("tgc", s.tgc);
  readTgcTable(table, s);
  if (s.tgc != Tgc::nominal) return table.unused(kNominal, "tgc = \"nominal\"");
  const double per_db_cm_mhz = nepersPerMetre(1, 1, kHz) / kHz;
  s.nominal_gain_np_per_m_hz =
      per_db_cm_mhz * table.number(kNominal, s.nominal_gain_np_per_m_hz / per_db_cm_mhz,
                                   ranges::kNominalGain_db_cm_mhz);
}

void readReference(TomlTable& table, SignalSettings& s) {
  if (table.has("reference_intensity")) {
    s.reference_intensity =
        table.number("reference_intensity", std::nullopt, ranges::kReferenceIntensity);
    table.unused("reference_percentile", "reference_intensity left out");
  } else {
    s.reference_percentile = kWhiteByMuscle;
    if (table.has("reference_percentile"))
      s.reference_percentile =
          table.number("reference_percentile", std::nullopt, {.lo = 0, .hi = 100, .lo_open = true});
  }
}

void readLookKeys(TomlTable& table, SignalSettings& s) {
  s.look = table.choice("look", s.look);
  if (s.look == Look::scanner)
    s.quality = table.choice("quality", s.quality);
  else
    table.unused("quality", "look = \"scanner\"");
}

}  // namespace

void takeLook(TomlTable signal, Scene& scene) {
  readLookKeys(signal, scene.signal);
  applyLook(scene.signal.look, scene.signal.quality, scene);
}

SignalSettings readSignal(TomlTable table, const SignalSettings& defaults) {
  SignalSettings s = defaults;
  readLookKeys(table, s);
  readTgc(table, s);
  s.spread = table.choice("spread", s.spread);
  s.beam_width = table.choice("beam_width", s.beam_width);
  if (s.beam_width == BeamWidth::fixed)
    s.beam_width_m =
        metresFromMillimetres(table.number("beam_width_mm", std::nullopt, ranges::kExtent_mm));
  else
    table.unused("beam_width_mm", "beam_width = \"fixed\"");
  s.pulse_cycles = table.number("pulse_cycles", s.pulse_cycles, {.lo = 0, .hi = 1000});
  s.dynamic_range_db =
      table.number("dynamic_range_db", s.dynamic_range_db, ranges::kDynamicRange_db);
  readReference(table, s);
  s.gain_db = table.number("gain_db", s.gain_db, ranges::kPictureGain_db);
  s.interface_gain_db =
      table.number("interface_gain_db", s.interface_gain_db, ranges::kPictureGain_db);
  constexpr std::string_view kLimit = "interface_limit_db";
  if (table.has(kLimit))
    s.interface_limit_db = table.number(kLimit, std::nullopt, ranges::kLevel_db);
  s.grey_gamma = table.number("grey_gamma", s.grey_gamma, ranges::kGamma);
  table.finish();
  return s;
}

TrabeculaeSettings readTrabeculae(TomlTable table, const TrabeculaeSettings& defaults) {
  TrabeculaeSettings t = defaults;
  t.deviation_m = readLength(table, "height_mm", t.deviation_m, ranges::kTrabeculae_mm);
  t.scale_m = readLength(table, "scale_mm", t.scale_m, ranges::kTrabeculaeScale_mm);
  t.seed = readSeed(table, "seed", t.seed);
  table.finish();
  return t;
}

SpeckleSettings readSpeckle(TomlTable table, const SpeckleSettings& defaults) {
  constexpr double kMostPerCell = 1000;  // statistics are final from 3 on; our choice
  const NumberRange times_ms{.lo = 0, .hi = 1e9};
  SpeckleSettings s = defaults;
  s.on = table.boolean("on", s.on);
  s.seed = readSeed(table, "seed", s.seed);
  s.per_cell = table.number("per_cell", s.per_cell, {.lo = 0.1, .hi = kMostPerCell});
  s.smoothing_m = readLength(table, "smoothing_mm", s.smoothing_m, {.lo = 0, .hi = 100});
  s.tissue_time_s = 1e-3 * table.number("tissue_time_ms", 1e3 * s.tissue_time_s, times_ms);
  s.blood_time_s = 1e-3 * table.number("blood_time_ms", 1e3 * s.blood_time_s, times_ms);
  s.heterogeneity_db =
      table.number("heterogeneity_db", s.heterogeneity_db, ranges::kHeterogeneity_db);
  s.heterogeneity_fine_m = readLength(table, "heterogeneity_fine_mm", s.heterogeneity_fine_m);
  s.heterogeneity_layer_m = readLength(table, "heterogeneity_layer_mm", s.heterogeneity_layer_m);
  s.heterogeneity_coarse_m = readLength(table, "heterogeneity_coarse_mm", s.heterogeneity_coarse_m);
  s.heterogeneity_seed = readSeed(table, "heterogeneity_seed", s.heterogeneity_seed);
  s.anisotropy_db = table.number("anisotropy_db", s.anisotropy_db, ranges::kLoss_db);
  s.helix_angle_rad = readAngle(table, "helix_angle_deg", s.helix_angle_rad, ranges::kHelix_deg);
  table.finish();
  return s;
}

ArtefactSettings readArtefacts(TomlTable table, const ArtefactSettings& defaults) {
  ArtefactSettings a = defaults;
  const auto level = [&](std::string_view key, double fallback) {
    return table.number(key, fallback, ranges::kLevel_db);
  };
  a.dropout = table.boolean("dropout", a.dropout);
  a.dropout_db = table.number("dropout_db", a.dropout_db, ranges::kLoss_db);
  a.acoustic_window = table.boolean("acoustic_window", a.acoustic_window);
  a.window_width_m = readLength(table, "window_width_mm", a.window_width_m);
  a.window_offset_m =
      readLength(table, "window_offset_mm", a.window_offset_m, ranges::kWindowOffset_mm);
  a.window_depth_m = readLength(table, "window_depth_mm", a.window_depth_m);
  a.window_shadow_db = table.number("window_shadow_db", a.window_shadow_db, ranges::kLoss_db);
  a.haze = table.boolean("haze", a.haze);
  a.haze_db = level("haze_db", a.haze_db);
  a.haze_width_rad = readAngle(table, "haze_width_deg", a.haze_width_rad);
  a.reverberation = table.boolean("reverberation", a.reverberation);
  a.reverberation_db = level("reverberation_db", a.reverberation_db);
  a.reverberation_length_m = readLength(table, "reverberation_length_mm", a.reverberation_length_m);
  a.clutter = table.boolean("clutter", a.clutter);
  a.clutter_db = level("clutter_db", a.clutter_db);
  a.clutter_length_m = readLength(table, "clutter_length_mm", a.clutter_length_m);
  a.clutter_width_rad = readAngle(table, "clutter_width_deg", a.clutter_width_rad);
  a.clutter_seed = readSeed(table, "clutter_seed", a.clutter_seed);
  a.noise = table.boolean("noise", a.noise);
  a.noise_db = level("noise_db", a.noise_db);
  a.noise_seed = readSeed(table, "noise_seed", a.noise_seed);
  a.persistence = table.number("persistence", a.persistence, ranges::kPersistence);
  table.finish();
  return a;
}

}  // namespace echocine
