// Every row of the table of scene keys: what it accepts, in files and in code.

#include "scene/scene_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "support/key_scene.h"

namespace echocine {
namespace {

using namespace support;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// How a number of a list stands in the file; "{}" for a plain one.
std::string shapeOf(const SceneKey& key) {
  static const std::map<std::string, std::string> kShapes{
      {"probe.apex", "[0, {}, 0]"},
      {"probe.shift_mm", "[0, {}, 0]"},
      {"motion.mesh_offset_mm", "[0, {}, 0]"},
      {"motion.keyframe_phases", "[{}]"},
      {"structure.keyframes", "[{{ file = \"a.obj\", phase = {} }}]"},
      {"truth.labels", "{{ ball = {} }}"}};
  const auto found = kShapes.find(key.fullName());
  return found == kShapes.end() ? "{}" : found->second;
}

bool isWhole(const SceneKey& key) {
  return key.field.kind == KeyKind::whole || key.fullName() == "truth.labels";
}

std::string inFile(const SceneKey& key, double value) {
  const std::string number =
      isWhole(key) ? fmt::format("{:.0f}", value) : fmt::format("{:.17g}", value);
  return fmt::format(fmt::runtime(shapeOf(key)), number);
}

bool isBounded(const SceneKey& key) {
  return std::isfinite(key.range.lo) || std::isfinite(key.range.hi);
}

double beyond(const SceneKey& key, double end, double way) {
  return isWhole(key) ? end + (way > 0 ? 1 : -1) : std::nextafter(end, way);
}

// An end of the range that is accepted, and the nearest number that is not; no infinite ones.
struct End {
  double accepted, refused;
};
std::vector<End> endsOf(const SceneKey& key) {
  std::vector<End> ends;
  const NumberRange& r = key.range;
  if (std::isfinite(r.lo))
    ends.push_back(r.lo_open ? End{std::nextafter(r.lo, kInfinity), r.lo}
                             : End{r.lo, beyond(key, r.lo, -kInfinity)});
  if (std::isfinite(r.hi))
    ends.push_back(r.hi_open ? End{std::nextafter(r.hi, -kInfinity), r.hi}
                             : End{r.hi, beyond(key, r.hi, kInfinity)});
  return ends;
}

bool isOneLine(const std::string& message) {
  return !message.empty() && message.find('\n') == std::string::npos;
}

TEST(SceneKeys, NoneStandsTwice) {
  std::set<std::string> names;
  for (const SceneKey& key : sceneKeys()) {
    EXPECT_TRUE(names.insert(key.fullName()).second) << key.fullName();
    EXPECT_FALSE(std::string(key.meaning).empty()) << key.fullName();
  }
  EXPECT_GT(names.size(), 130u);
}

TEST(SceneKeys, TheReaderAcceptsTheEndsOfEachRangeAndNothingBeyond) {
  int ends = 0;
  for (const SceneKey& key : sceneKeys()) {
    if (!isBounded(key)) continue;
    const std::string name = key.fullName();
    for (const End& end : endsOf(key)) {
      KeyScene text(key);
      text.set(name, inFile(key, end.accepted));
      // Other keys may contradict it; the number itself is accepted.
      EXPECT_EQ(text.refusal().find(std::string(key.name) + ": is "), std::string::npos)
          << text.refusal();
      text.set(name, inFile(key, end.refused));
      const std::string refusal = text.refusal();
      EXPECT_NE(refusal.find(key.name), std::string::npos)
          << name << " " << end.refused << ": " << refusal;
      EXPECT_TRUE(isOneLine(refusal)) << name;
      ++ends;
    }
  }
  EXPECT_GT(ends, 150);
}

// Accepts each value of a choice.
KeyScene withValue(const SceneKey& key, const std::string& value) {
  if (key.fullName() == "probe.kind" && value == "\"linear\"")
    return KeyScene(sceneKey("probe", "width_mm"));
  KeyScene text(key);
  text.set(key.fullName(), value);
  if (value == "\"radial\"") text.remove("probe.sector_deg");
  const std::map<std::string, std::pair<std::string, std::string>> companions{
      {"\"curvilinear\"", {"probe.face_radius_mm", "60"}},
      {"\"radial\"", {"probe.face_radius_mm", "2"}},
      {"\"table\"", {"signal.tgc_table_mm_db", "[[0, 0]]"}},
      {"\"fixed\"", {"signal.beam_width_mm", "2"}},
      {"\"on\"", {"accuracy.rays_per_beam", "2"}}};
  if (const auto found = companions.find(value); found != companions.end())
    text.set(found->second.first, found->second.second);
  return text;
}

TEST(SceneKeys, TheReaderKeepsChoicesAndRefusesOtherWords) {
  for (const SceneKey& key : sceneKeys()) {
    std::vector<std::string> values;
    if (key.field.kind == KeyKind::flag) values = {"true", "false"};
    if (key.field.kind == KeyKind::word)
      for (const std::string_view word : key.field.words())
        values.push_back(fmt::format("\"{}\"", word));
    for (const std::string& value : values) {
      Scene scene;
      ASSERT_NO_THROW(scene = withValue(key, value).scene()) << withValue(key, value).refusal();
      const KeyValue kept = key.field.get(ownerOf(scene));
      const auto* const flag = std::get_if<bool>(&kept);
      EXPECT_EQ(flag ? std::string(*flag ? "true" : "false")
                     : fmt::format("\"{}\"", std::get<std::string>(kept)),
                value)
          << key.fullName();
    }
    if (values.empty()) continue;
    KeyScene text(key);
    text.set(key.fullName(), "\"no such word\"");
    EXPECT_NE(text.refusal().find(std::string(key.name) + ": is "), std::string::npos)
        << text.refusal();
    EXPECT_TRUE(isOneLine(text.refusal()));
  }
}

TEST(SceneKeys, TheReaderKeepsNumbersInSI) {
  int kept = 0;
  for (const SceneKey& key : sceneKeys()) {
    if (!isNumber(key) || std::string_view(key.table).starts_with("media")) continue;
    KeyScene text(key);
    const double value = key.range.contains(3) ? 3 : key.range.contains(0.25) ? 0.25 : 50;
    text.set(key.fullName(), inFile(key, value));
    Scene scene;
    ASSERT_NO_THROW(scene = text.scene()) << text.refusal();
    EXPECT_EQ(key.field.get(ownerOf(scene)), inCode(key, key.unit.to_si(value))) << key.fullName();
    ++kept;
  }
  EXPECT_GT(kept, 70);
}

TEST(SceneKeys, RangesHoldForScenesBuiltInCode) {
  int ends = 0;
  for (const SceneKey& key : sceneKeys()) {
    if (!isNumber(key) || !isBounded(key) || std::string_view(key.table).starts_with("media"))
      continue;
    KeyScene text(key);
    for (const char* needed : {"probe.width_mm", "probe.face_radius_mm", "signal.beam_width_mm"})
      if (key.fullName() == needed) text.set(needed, "30");
    if (key.fullName() == "probe.face_radius_mm") text.set("probe.kind", "\"curvilinear\"");
    const Scene scene = text.scene();
    EXPECT_NO_THROW(refuseOutOfRange(scene));
    const auto refusalOf = [&](const KeyValue& value) -> std::optional<std::string> {
      Scene changed = scene;
      key.field.set(ownerOf(changed), value);
      // A number that stands for something else, such as white by the heart's muscle.
      if (std::holds_alternative<std::monostate>(key.field.get(ownerOf(changed))))
        return std::nullopt;
      try {
        refuseOutOfRange(changed);
      } catch (const SceneError& error) {
        return error.what();
      }
      return std::string();
    };
    for (const End& end : endsOf(key)) {
      if (isWhole(key) && std::abs(end.refused) > std::numeric_limits<int>::max()) continue;
      EXPECT_EQ(refusalOf(inCode(key, key.unit.to_si(end.accepted))), "") << key.fullName();
      // A step in SI, which may be smaller than one in the file's unit.
      const bool open = end.accepted != key.range.lo && end.accepted != key.range.hi;
      const double at = key.unit.to_si(end.refused), way = end.refused > end.accepted ? 1 : -1;
      const double outside =
          open || isWhole(key) ? at : std::nextafter(key.unit.to_si(end.accepted), way * kInfinity);
      const std::optional<std::string> refusal = refusalOf(inCode(key, outside));
      if (!refusal) continue;
      EXPECT_NE(refusal->find(key.name), std::string::npos) << key.fullName();
      EXPECT_NE(refusal->find("accepted: " + key.accepted()), std::string::npos) << *refusal;
      EXPECT_TRUE(isOneLine(*refusal)) << *refusal;
      ++ends;
    }
    const KeyValue nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(key.field.kind == KeyKind::number ? refusalOf(nan) : "whole", "") << key.fullName();
  }
  EXPECT_GT(ends, 130);
}

}  // namespace
}  // namespace echocine
