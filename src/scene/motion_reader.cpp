#include "scene/motion_reader.h"

#include <fmt/format.h>

#include "core/units.h"
#include "scene/key_reader.h"
#include "scene/ranges.h"

namespace echocine {

namespace {

constexpr std::string_view kInterval = "keyframe_interval_ms";

void refuseEndAlone(TomlTable& table, const MotionSettings& m) {
  if (m.end_systole_phase && !m.keyframe_heart_rate_hz && !table.has(kInterval))
    table.fail(
        "end_systole_phase",
        "has no effect alone, accepted: with keyframe_heart_rate_bpm or " + std::string(kInterval));
}

std::vector<double> readKeyframePhases(TomlTable& table) {
  const char* key = "keyframe_phases";
  const std::vector<double> phases = table.numbers(key);
  for (std::size_t i = 0; i < phases.size(); ++i) {
    if (phases[i] == 1 && i > 0)
      table.fail(key,
                 fmt::format("phase {} is 1, the beat's start again: drop the frame that closes "
                             "the beat, the first keyframe follows the last automatically",
                             i + 1));
    if (!(phases[i] >= 0 && phases[i] < 1))
      table.fail(key,
                 fmt::format("phase {} is {}, accepted: at least 0 and below 1", i + 1, phases[i]));
    if (i > 0 && !(phases[i] - phases[i - 1] >= ranges::kLeastPhaseStep))
      table.fail(key,
                 fmt::format("phase {} is {} after {}, accepted: ascending phases, {} apart or "
                             "more",
                             i + 1, phases[i], phases[i - 1], ranges::kLeastPhaseStep));
  }
  return phases;
}

void readInterval(TomlTable& table, MotionKeys& keys) {
  if (!table.has(kInterval)) return;
  keys.interval_s = readNumber(table, sceneKey("motion", kInterval));
  keys.interval_place = table.place(kInterval);
  for (const char* other : {"keyframe_heart_rate_bpm", "keyframe_phases"})
    if (table.has(other))
      table.fail(kInterval,
                 fmt::format("contradicts {}: the interval times the number of keyframes "
                             "is the beat; omit one of the two",
                             other));
}

}  // namespace

MotionKeys readMotion(TomlTable table, Scene& scene) {
  MotionKeys keys;
  MotionSettings& m = scene.motion;
  readKeys(table, "motion", {&scene});
  if (table.has("mesh_offset_mm"))
    m.mesh_offset_m =
        metresFromMillimetres(1) * table.vector("mesh_offset_mm", ranges::kMostOffset_mm);
  readInterval(table, keys);
  m.interpolation_given = table.has("interpolation");
  refuseEndAlone(table, m);
  m.keyframe_phases = readKeyframePhases(table);
  m.interpolation_place = table.place("interpolation");
  m.subdivision_place = table.place("subdivision");
  table.finish();
  return keys;
}

std::optional<double> rateOfInterval(const MotionKeys& keys,
                                     const std::vector<Structure>& structures) {
  if (!keys.interval_s) return std::nullopt;
  const auto fail = [&](const std::string& what) {
    throw SceneError(atPlace(keys.interval_place, what));
  };
  const Structure* moving = nullptr;
  for (const Structure& s : structures) {
    if (s.keyframes.size() < 2) continue;
    if (s.phases_given)
      fail(fmt::format("contradicts the phases of {}: omit one of the two", s.name));
    if (!moving) moving = &s;
    if (s.keyframes.size() != moving->keyframes.size())
      fail(fmt::format(
          "is one beat for all, but {} has {} keyframes and {} has {}: accepted with as "
          "many for each, or keyframe_heart_rate_bpm",
          moving->name, moving->keyframes.size(), s.name, s.keyframes.size()));
  }
  if (!moving) fail("has no effect on structures with one keyframe: omit it");
  const double beat_s = *keys.interval_s * static_cast<double>(moving->keyframes.size());
  if (!ranges::kHeartRates_bpm.contains(60 / beat_s))
    fail(fmt::format(
        "times the {} keyframes of {} is a beat of {:.4g} s, {:.4g} per minute; accepted: "
        "{} of it",
        moving->keyframes.size(), moving->name, beat_s, 60 / beat_s,
        ranges::kHeartRates_bpm.text()));
  return 1 / beat_s;
}

}  // namespace echocine
