#include "live/live_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/file.h"
#include "core/nearest_word.h"
#include "motion/surfaces/probe_placement.h"
#include "scene/probe_pose.h"
#include "scene/toml_edit.h"
#include "scene/toml_flat.h"

namespace echocine::live {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostTextBytes = 4 << 20;  // as readScene()
constexpr std::array kOfView{"view", "shift_mm", "rotate_deg", "tilt_deg"};

// Tables whose keys neither change meshes nor files.
bool isLiveTable(std::string_view table) {
  constexpr std::array<std::string_view, 9> kTables{"probe",    "acquisition", "effects",
                                                    "signal",   "speckle",     "trabeculae",
                                                    "leaflets", "artefacts",   "accuracy"};
  return std::find(kTables.begin(), kTables.end(), table) != kTables.end();
}

void refuseUnlessLiveKey(const std::string& name) {
  std::vector<std::string> known;
  for (const SceneKey& key : sceneKeys())
    if (isLiveKey(key)) known.push_back(key.fullName());
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  const std::string nearest = nearestWord(name, known);
  throw SceneError(fmt::format("{}: is not a key that can be changed live{}", name,
                               nearest.empty() ? "" : ", nearest: " + nearest));
}

[[noreturn]] void refuseValue(const std::string& key) {
  throw SceneError(fmt::format(
      "{}: accepted: a number, a word, true, false, a list of numbers or of pairs, or null", key));
}

// As TOML. Lists may hold lists once, as in tgc_table_mm_db.
std::string tomlValue(const std::string& key, const Json& value, int lists_left = 2) {
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number_integer()) return value.dump();
  if (value.is_number_float() && std::isfinite(value.get<double>())) {
    const std::string text = fmt::format("{}", value.get<double>());
    const bool whole = text.find_first_of(".en") == std::string::npos;
    return whole ? text + ".0" : text;
  }
  if (value.is_string() && value.get_ref<const std::string&>().size() < 64)
    return value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (!value.is_array() || value.size() > 64 || lists_left == 0) refuseValue(key);
  std::string text;
  for (const Json& entry : value)
    text += (text.empty() ? "" : ", ") + tomlValue(key, entry, lists_left - 1);
  return "[" + text + "]";
}

// The lines of poseToml() as edits.
void addPose(const std::string& lines, std::vector<TomlEdit>& edits) {
  for (std::size_t begin = 0; begin < lines.size();) {
    const std::size_t end = std::min(lines.find('\n', begin), lines.size());
    const std::string line = lines.substr(begin, end - begin);
    if (const std::size_t equals = line.find(" = "); equals != std::string::npos)
      edits.push_back({"probe." + line.substr(0, equals), line.substr(equals + 3)});
    begin = end + 1;
  }
}

}  // namespace

bool isLiveKey(const SceneKey& key) {
  const bool of_view =
      std::string_view(key.table) == "probe" &&
      std::find(kOfView.begin(), kOfView.end(), std::string_view(key.name)) != kOfView.end();
  return isLiveTable(key.table) && !of_view;
}

LiveScene::LiveScene(const std::filesystem::path& file)
    : LiveScene(file, readTextFile(file, kMostTextBytes), {}) {}

LiveScene::LiveScene(std::filesystem::path file, std::string text, NamedMeshes meshes)
    : file_(std::move(file)), given_(std::move(text)), text_(given_), meshes_(std::move(meshes)) {
  const Scene scene = read(text_);
  if (!scene.view) return;
  std::vector<TomlEdit> edits;
  for (const char* name : kOfView) edits.push_back({fmt::format("probe.{}", name), std::nullopt});
  addPose(poseToml(placed(scene)), edits);
  text_ = withEdits(text_, edits, file_.string());
}

LiveScene::LiveScene(const LiveScene& of, std::string text, NamedMeshes meshes)
    : file_(of.file_), given_(of.given_), text_(std::move(text)), meshes_(std::move(meshes)) {}

std::string LiveScene::textWith(const Json& keys) const {
  if (!keys.is_object()) throw SceneError("keys: accepted: an object of key and value");
  std::vector<TomlEdit> edits;
  for (const auto& [key, value] : keys.items()) {
    refuseUnlessLiveKey(key);
    edits.push_back(
        {key, value.is_null() ? std::nullopt : std::optional<std::string>(tomlValue(key, value))});
  }
  return withEdits(text_, edits, file_.string());
}

Scene LiveScene::read(const std::string& text) const {
  return meshes_.empty() ? parseScene(text, file_) : parseScene(text, file_, meshes_);
}

std::vector<LiveScene::Change> LiveScene::changes(const std::string& text) const {
  const auto before = flatValues(given_, file_.string()), after = flatValues(text, file_.string());
  std::vector<Change> changes;
  for (const auto& [key, from] : before)
    if (const auto found = after.find(key); found == after.end())
      changes.push_back({key, from, ""});
    else if (found->second != from)
      changes.push_back({key, from, found->second});
  for (const auto& [key, to] : after)
    if (!before.contains(key)) changes.push_back({key, "", to});
  std::sort(changes.begin(), changes.end(),
            [](const Change& a, const Change& b) { return a.key < b.key; });
  return changes;
}

}  // namespace echocine::live
