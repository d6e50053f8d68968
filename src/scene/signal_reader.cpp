#include "scene/signal_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/units.h"
#include "scene/ranges.h"

namespace echocine {

namespace {

// Keeps intensities within floats; scanners end at 100. Our choice.
constexpr double kMaxGainDb = 200;

void readTgc(TomlTable& table, SignalSettings& s) {
  s.tgc = table.choice("tgc", s.tgc);
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

}  // namespace

SpeckleSettings readSpeckle(TomlTable table) {
  constexpr double kMostPerCell = 1000;  // statistics are final from 3 on; our choice
  const NumberRange times_ms{.lo = 0, .hi = 1e9};
  SpeckleSettings s;
  s.on = table.boolean("on", s.on);
  s.seed = table.integer("seed", s.seed, 0, std::numeric_limits<int>::max());
  s.per_cell = table.number("per_cell", s.per_cell, {.lo = 0.1, .hi = kMostPerCell});
  s.smoothing_m = metresFromMillimetres(
      table.number("smoothing_mm", millimetresFromMetres(s.smoothing_m), {.lo = 0, .hi = 100}));
  s.tissue_time_s = 1e-3 * table.number("tissue_time_ms", 1e3 * s.tissue_time_s, times_ms);
  s.blood_time_s = 1e-3 * table.number("blood_time_ms", 1e3 * s.blood_time_s, times_ms);
  table.finish();
  return s;
}

SignalSettings readSignal(TomlTable table) {
  SignalSettings s;
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
  if (table.has("reference_intensity")) {
    s.reference_intensity =
        table.number("reference_intensity", std::nullopt, ranges::kReferenceIntensity);
    table.unused("reference_percentile", "reference_intensity left out");
  } else {
    s.reference_percentile = table.number("reference_percentile", s.reference_percentile,
                                          {.lo = 0, .hi = 100, .lo_open = true});
  }
  s.grey_gamma = table.number("grey_gamma", s.grey_gamma, ranges::kGamma);
  table.finish();
  return s;
}

}  // namespace echocine
