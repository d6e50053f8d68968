// The reference scene and the scene room's page name every key as the table of keys has it.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "core/units.h"
#include "scene/scene_json.h"
#include "scene/scene_keys.h"
#include "scene/scene_reader.h"
#include "support/paths.h"
#include "support/run_files.h"

namespace echocine {
namespace {

const std::filesystem::path kReference =
    std::filesystem::path(support::kSourceDir) / "examples/every_key/scene.toml";

TEST(EveryKey, ValuesThatAreCalledDefaultsAre) {
  const Scene reference = readScene(kReference);
  Scene defaults;  // as the structs have them
  const auto json = [](const Scene& scene, const char* part) {
    Scene copy = scene;
    copy.media = {Medium{}};
    copy.background = MediumId{};
    copy.structures.clear();
    return sceneJson(copy)[part];
  };
  for (const char* part :
       {"unit_volume_m3", "acquisition", "effects", "signal", "accuracy", "output"})
    EXPECT_EQ(json(reference, part), json(defaults, part)) << part;
  EXPECT_EQ(reference.motion.interpolation, defaults.motion.interpolation);
}

TEST(EveryKey, ProbeKeysThatAreLeftOutTakeTheReferencesValues) {
  const Scene reference = readScene(kReference);
  const Scene plain =
      readScene(std::filesystem::path(support::kSourceDir) / "examples/beating_heart/scene.toml");
  EXPECT_EQ(plain.probe.aperture_m, reference.probe.aperture_m);
  const auto focus = [](const Probe& p) { return p.focus_m / p.max_depth_m; };
  EXPECT_NEAR(focus(plain.probe), focus(reference.probe), 1e-12);
  EXPECT_EQ(plain.probe.min_depth_m, reference.probe.min_depth_m);
  EXPECT_EQ(reference.structures[0].reflection_gain, Structure{}.reflection_gain);
  EXPECT_EQ(reference.structures[0].reflection_exponent, Structure{}.reflection_exponent);
  EXPECT_EQ(reference.structures[0].coherent_share, Structure{}.coherent_share);
  EXPECT_EQ(reference.structures[0].repair.any(), Structure{}.repair.any());
}

// In the file's unit; empty where there is none.
std::string defaultOf(const SceneKey& key) {
  if (key.need == KeyNeed::always) return "needed";
  Scene scene;
  scene.view.emplace();
  Structure structure;
  MediumSpec medium;
  if (key.fallback)
    return fmt::format("{:g}{}", *key.fallback,
                       key.need == KeyNeed::unless_view ? " with view, else needed" : "");
  if (key.need == KeyNeed::unless_view) return "needed without view";
  if (key.need == KeyNeed::found || key.field.get == nullptr) return "";
  const KeyValue value = key.field.get({&scene, &structure, &medium});
  if (const auto* const number = std::get_if<double>(&value))
    return fmt::format("{:.6g}", key.unit.from_si(*number));
  if (const auto* const whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
  if (const auto* const flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* const word = std::get_if<std::string>(&value)) return *word;
  return "";
}

std::string join(std::initializer_list<std::string> parts, const char* between) {
  std::string joined;
  for (const std::string& part : parts)
    if (!part.empty()) joined += (joined.empty() ? "" : between) + part;
  return joined;
}

// Words between `bar`; of numbers the range.
std::string acceptedOf(const SceneKey& key, const char* bar) {
  if (key.field.words && !key.field.words().empty())
    return fmt::format("{}", fmt::join(key.field.words(), bar));
  const bool list = key.field.kind == KeyKind::other && std::isfinite(key.range.lo);
  if (key.field.kind != KeyKind::number && key.field.kind != KeyKind::whole && !list) return "";
  std::string text = list ? key.range.text() : key.accepted();
  for (const std::string_view word : {"a number ", "a whole number ", "from "})
    if (text.starts_with(word)) text.erase(0, word.size());
  return text;
}

std::string useOf(const SceneKey& key) {
  if (!key.use.with) return "";
  return std::regex_replace(fmt::format("only with {}", key.use.with), std::regex(R"( \| )"),
                            " or ");
}

// What stands behind a key in the reference scene.
std::string commentOf(const SceneKey& key) {
  const std::string value = defaultOf(key);
  return join(
      {value.starts_with("needed") ? value : "", acceptedOf(key, " | "), key.meaning, useOf(key)},
      "; ");
}

// The page's list, a table of Markdown for each table of a scene.
std::string listOfKeys() {
  std::string list, table = "none";
  for (const SceneKey& key : sceneKeys()) {
    if (table != key.table) {
      table = key.table;
      const std::string head = table.empty()          ? "At the top"
                               : table == "structure" ? "`[[structure]]`"
                               : table.starts_with("media")
                                   ? "`[media.NAME" + table.substr(5) + "]`"
                                   : "`[" + table + "]`";
      list += fmt::format("\n### {}\n\n| key | accepted | default | meaning |\n|---|---|---|---|\n",
                          head);
    }
    list += fmt::format("| `{}` | {} | {} | {} |\n", key.name, acceptedOf(key, ", "),
                        defaultOf(key), join({key.meaning, useOf(key)}, "; "));
  }
  return list;
}

// The text with its list of keys made anew. Precondition: the list ends the page.
std::string withList(const std::string& page) {
  const std::string head = "## Every key\n";
  const std::size_t at = page.find(head);
  return page.substr(0, at) + head + listOfKeys();
}

// The reference scene's text with comments of the table's rows, and the keys that it names.
std::string withComments(const std::string& text, std::set<std::string>& named) {
  static const std::regex kHead(R"(^(?:# )?\[+([a-z]+)(?:\.[a-z]+)?\]+.*)"),
      kLine(R"(^((?:# )?([a-z_][a-z_0-9]*) = [^#]*?)\s*(?:#.*)?$)");
  std::istringstream lines(text);
  std::string line, table, made;
  while (std::getline(lines, line)) {
    std::smatch match;
    if (std::regex_match(line, match, kHead)) table = match[1];
    if (std::regex_match(line, match, kLine))
      if (const SceneKey* const key = findSceneKey(table, match[2].str())) {
        named.insert(key->fullName());
        line = fmt::format("{:<32} # {}", match[1].str(), commentOf(*key));
      }
    made += line + "\n";
  }
  return made;
}

// Compares, or writes it anew.
void expectText(const std::filesystem::path& file, const std::string& made) {
  if (std::getenv("ECHOCINE_WRITE_KEYS") != nullptr) std::ofstream(file) << made;
  EXPECT_TRUE(support::bytesOf(file) == made)
      << file << " is not what the table of keys says; ECHOCINE_WRITE_KEYS=1 writes it anew";
}

TEST(EveryKey, TheReferenceSceneSaysWhatTheTableSays) {
  std::set<std::string> named;
  expectText(kReference, withComments(support::bytesOf(kReference), named));
  for (const SceneKey& key : sceneKeys())
    if (std::string_view(key.table) != "media.backscatter") {  // in data/media.toml
      EXPECT_EQ(named.count(key.fullName()), 1u) << key.fullName();
    }
}

TEST(EveryKey, ThePageOfTheSceneRoomListsThem) {
  const auto page = std::filesystem::path(support::kSourceDir) / "src/scene/README.md";
  expectText(page, withList(support::bytesOf(page)));
}

}  // namespace
}  // namespace echocine
