#include "scene/signal_reader.h"

#include <fmt/format.h>

#include <cmath>

#include "core/units.h"
#include "scene/key_reader.h"
#include "scene/looks.h"
#include "scene/ranges.h"
#include "scene/white_rule.h"

namespace echocine {

namespace {

// Keeps intensities within floats; scanners end at 100. Our choice.
constexpr double kMaxGainDb = 200;

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

}  // namespace

void takeLook(TomlTable signal, Scene& scene) {
  for (const char* name : {"look", "quality"}) readKey(signal, sceneKey("signal", name), {&scene});
  applyLook(scene.signal.look, scene.signal.quality, scene);
}

void readSignal(TomlTable table, Scene& scene) {
  SignalSettings& s = scene.signal;
  // First, as white by percentile depends on it.
  readKey(table, sceneKey("signal", "reference_intensity"), {&scene});
  if (!s.reference_intensity) s.reference_percentile = kWhiteByMuscle;
  readKeys(table, "signal", {&scene});
  readTgcTable(table, s);
  table.finish();
}

}  // namespace echocine
