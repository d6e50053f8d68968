#include "live/live_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scene/probe_pose.h"

namespace echocine::live {

namespace {

using Json = LiveJson;

struct Field {
  const char* name;
  bool (*accepts)(const Json&);
  const char* accepted;
};

bool isFrame(const Json& value) {
  return value.is_number_integer() && value >= 0 && value < 1000000;
}

bool isWordOf(const Json& value, std::initializer_list<const char*> words) {
  return value.is_string() &&
         std::any_of(words.begin(), words.end(), [&](const char* w) { return value == w; });
}

bool areNumbers(const Json& value, std::size_t most) {
  return value.is_object() && value.size() <= most &&
         std::all_of(value.begin(), value.end(),
                     [](const Json& v) { return v.is_number() && std::isfinite(v.get<double>()); });
}

// From "1", so that they can be object keys.
bool isSegment(const std::string& key) {
  return !key.empty() && key.size() <= 2 &&
         std::all_of(key.begin(), key.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool areSegments(const Json& value) {
  if (!areNumbers(value, heart::kSegments)) return false;
  for (const auto& entry : value.items())
    if (!isSegment(entry.key())) return false;
  return true;
}

bool areLayers(const Json& value) {
  return value.is_array() && value.size() <= 2 &&
         std::all_of(value.begin(), value.end(), [](const Json& v) {
           return isWordOf(v, {"labels", "wall"});
         });
}

constexpr Field kFields[] = {
    {"keys", [](const Json& v) { return v.is_object() && v.size() <= 200; }, "an object"},
    {"frame", &isFrame, "a whole number from 0"},
    {"wrap", [](const Json& v) { return v.is_boolean(); }, "true | false"},
    {"effort",
     [](const Json& v) {
       return isWordOf(v, {"moving", "still"});
     },
     "\"moving\" | \"still\""},
    {"name", [](const Json& v) { return v.is_string(); }, "a file name"},
    {"replace", [](const Json& v) { return v.is_boolean(); }, "true | false"},
    {"view", [](const Json& v) { return v.is_string(); }, "a standard view"},
    {"dials", [](const Json& v) { return areNumbers(v, 32); }, "an object of numbers"},
    {"segments", &areSegments, "an object of amplitudes by segment"},
    {"format",
     [](const Json& v) {
       return isWordOf(v, {"mp4", "gif", "webp"});
     },
     "\"mp4\" | \"gif\" | \"webp\""},
    {"layers", &areLayers, "a list of \"labels\" | \"wall\""}};

}  // namespace

std::optional<Json> jsonOf(const std::string& body) {
  constexpr int kMostDepth = 16;  // our choice: bodies of the page have 4
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < body.size(); ++i) {
    const char c = body[i];
    if (in_text && c == '\\') ++i;
    if (c == '"') in_text = !in_text;
    if (in_text) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kMostDepth) return std::nullopt;
  }
  Json json = Json::parse(body, nullptr, false);
  return json.is_discarded() ? std::nullopt : std::optional(std::move(json));
}

std::string faultOf(const Json& body) {
  if (!body.is_object()) return "the body is not a JSON object";
  for (const auto& entry : body.items()) {
    const std::string& name = entry.key();
    const Json& value = entry.value();
    const auto* field = std::find_if(std::begin(kFields), std::end(kFields),
                                     [&](const Field& f) { return name == f.name; });
    if (field == std::end(kFields)) return fmt::format("{}: is not a known field", name);
    if (!field->accepts(value)) return fmt::format("{}: accepted: {}", name, field->accepted);
  }
  return {};
}

const Json& keysOf(const Json& body) {
  static const Json kNone = Json::object();
  const auto found = body.find("keys");
  return found == body.end() ? kNone : *found;
}

int frameOf(const Json& body) {
  return body.value("frame", 0);
}

HeartChange heartChangeOf(const Json& body) {
  HeartChange change;
  if (body.contains("dials"))
    for (const auto& dial : body["dials"].items()) change.dials[dial.key()] = dial.value();
  if (body.contains("segments"))
    for (const auto& segment : body["segments"].items())
      change.segments[std::stoi(segment.key())] = segment.value();
  return change;
}

bool hasLayer(const Json& body, const std::string& layer) {
  const auto found = body.find("layers");
  return found != body.end() && std::find(found->begin(), found->end(), layer) != found->end();
}

Json poseJson(Vec3d apex_m, Vec3d axis, Vec3d lateral, const Scene& scene) {
  const auto listOf = [](Vec3d v) { return Json{v.x, v.y, v.z}; };
  return {{"probe.apex", listOf((1 / scene.motion.mesh_unit_m) * apex_m)},
          {"probe.axis", listOf(axis)},
          {"probe.lateral", listOf(lateral)}};
}

bool isPoseKey(std::string_view key) {
  return key == "probe.apex" || key == "probe.axis" || key == "probe.lateral";
}

std::optional<Pose> poseFrom(const Json& keys, const Scene& scene) {
  std::array<Vec3d, 3> vectors;
  std::size_t count = 0;
  for (const char* key : {"probe.apex", "probe.axis", "probe.lateral"}) {
    const Json& list = keys.at(key);
    const bool numbers = list.is_array() && list.size() == 3 && list[0].is_number() &&
                         list[1].is_number() && list[2].is_number();
    if (!numbers) return std::nullopt;
    const Vec3d v{list[0].get<double>(), list[1].get<double>(), list[2].get<double>()};
    if (!isFinite(v) || std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) > 1e4)
      return std::nullopt;
    vectors[count++] = v;
  }
  if (vectors[1] == Vec3d{} || vectors[2] == Vec3d{}) return std::nullopt;
  return poseOf(scene.motion.mesh_unit_m * vectors[0], vectors[1], vectors[2]);
}

bool isSceneName(const std::string& name) {
  const auto plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
           c == '-' || c == '.';
  };
  return name.size() > 5 && name.size() <= 100 && name.ends_with(".toml") && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), plain);
}

}  // namespace echocine::live
