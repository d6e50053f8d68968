#include "live/live_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/stage_clock.h"
#include "live/live_page.h"
#include "live/picture_bytes.h"
#include "motion/surfaces/probe_placement.h"
#include "scene/names.h"
#include "scene/probe_pose.h"
#include "scene/view_names.h"
#include "video/cine_writer.h"

namespace echocine::live {

namespace {

using Json = nlohmann::ordered_json;

HttpResponse jsonResponse(const Json& json) {
  return {200, "application/json", json.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

// The fields of a body; others are refused. All are optional for this function.
struct Field {
  const char* name;
  bool (*accepts)(const Json&);
  const char* accepted;
};

bool isFrame(const Json& value) {
  return value.is_number_integer() && value >= 0 && value < 1000000;
}

constexpr Field kFields[] = {
    {"keys", [](const Json& v) { return v.is_object() && v.size() <= 200; }, "an object"},
    {"frame", &isFrame, "a whole number from 0"},
    {"effort", [](const Json& v) { return v == "moving" || v == "still"; },
     "\"moving\" | \"still\""},
    {"name", [](const Json& v) { return v.is_string(); }, "a file name"},
    {"replace", [](const Json& v) { return v.is_boolean(); }, "true | false"},
    {"view", [](const Json& v) { return v.is_string(); }, "a standard view"}};

// Empty, or why the body is refused.
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

Json listOf(Vec3d v) {
  return {v.x, v.y, v.z};
}

// The pose as keys of the scene.
Json poseJson(const Scene& scene) {
  const Pose& pose = scene.probe.pose;
  return {{"probe.apex", listOf((1 / scene.motion.mesh_unit_m) * pose.origin)},
          {"probe.axis", listOf(pose.z_axis)},
          {"probe.lateral", listOf(pose.x_axis)}};
}

bool isPoseKey(std::string_view key) {
  return key == "probe.apex" || key == "probe.axis" || key == "probe.lateral";
}

// A pose of three lists of three numbers, if it is one; otherwise the scene's reader says why not.
std::optional<Pose> poseFrom(const Json& keys, const std::optional<Scene>& scene) {
  if (!scene) return std::nullopt;
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
  return poseOf(scene->motion.mesh_unit_m * vectors[0], vectors[1], vectors[2]);
}

// A file name without folders that ends in .toml.
bool isSceneName(const std::string& name) {
  const auto plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
           c == '-' || c == '.';
  };
  return name.size() > 5 && name.size() <= 100 && name.ends_with(".toml") && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), plain);
}

}  // namespace

LiveSession::LiveSession(const std::filesystem::path& scene_file,
                         std::filesystem::path record_folder)
    : scene_(scene_file), record_folder_(std::move(record_folder)) {
  const Scene scene = scene_.read(scene_.text());
  renderer_ = std::make_unique<LiveRenderer>(scene);
  const Simulator& simulator = renderer_->prepared(scene, scene_.text());
  warnings_ = scene.warnings;
  warnings_.insert(warnings_.end(), simulator.plan().warnings.begin(),
                   simulator.plan().warnings.end());
  page_ = pageOf(simulator, scene_);
  if (!record_folder_.empty()) makeFolder(record_folder_);
}

LiveSession::~LiveSession() = default;

std::variant<HttpResponse, LiveJob> LiveSession::answer(const HttpRequest& request) {
  if (request.method == "GET") {
    if (request.path == "/") return HttpResponse{200, "text/html; charset=utf-8", page_};
    return lineResponse(404, "not found");
  }
  using Answer = HttpResponse (LiveSession::*)(const Json&);
  struct Route {
    const char* path;
    Answer answer;
  };
  constexpr Route kRoutes[] = {{"/picture", &LiveSession::picture}, {"/png", &LiveSession::png},
                               {"/scene", &LiveSession::sceneText}, {"/save", &LiveSession::save},
                               {"/view", &LiveSession::view},       {"/truth", &LiveSession::truth},
                               {"/effects", &LiveSession::effects}};
  const auto* route = std::find_if(std::begin(kRoutes), std::end(kRoutes),
                                   [&](const Route& r) { return request.path == r.path; });
  if (route == std::end(kRoutes)) return lineResponse(404, "not found");
  Json body = Json::parse(request.body, nullptr, false);
  if (body.is_discarded()) return lineResponse(400, "the body is not JSON");
  if (const std::string fault = faultOf(body); !fault.empty()) return lineResponse(400, fault);
  LiveJob job;
  job.picture = request.path == "/picture";
  job.gives_way = job.picture && body.value("effort", "still") == "still";
  job.run = [this, answer = route->answer, body = std::move(body)] {
    try {
      return (this->*answer)(body);
    } catch (const SceneError& error) {
      return lineResponse(422, error.what());
    }
  };
  return job;
}

// The scene of a moving picture. Without a change of settings only the pose is read anew.
const Scene& LiveSession::withPose(const Json& keys) {
  Json settings = Json::object(), pose = Json::object();
  for (const auto& [key, value] : keys.items()) (isPoseKey(key) ? pose : settings)[key] = value;
  const std::string name = settings.dump(-1, ' ', true, Json::error_handler_t::replace);
  const std::optional<Pose> quick =
      pose.size() == 3 ? poseFrom(pose, scene_of_settings_) : std::nullopt;
  if (!scene_of_settings_ || settings_ != name || !quick) {
    scene_of_settings_ = scene_.read(scene_.textWith(keys));
    settings_ = name;
  } else {
    scene_of_settings_->probe.pose = *quick;
  }
  return *scene_of_settings_;
}

HttpResponse LiveSession::picture(const Json& body) {
  const Json& keys = keysOf(body);
  if (body.value("effort", "still") == "moving") {
    const Scene& scene = withPose(keys);
    return {
        200, "application/octet-stream",
        pictureBytes(renderer_->moving(scene, settings_, frameOf(body)), scene, Effort::moving)};
  }
  const std::string text = scene_.textWith(keys);
  const Scene scene = scene_.read(text);
  const LivePicture made = renderer_->still(scene, text, frameOf(body));
  record(text);
  return {200, "application/octet-stream", pictureBytes(made, scene, Effort::still)};
}

HttpResponse LiveSession::png(const Json& body) {
  const std::string text = scene_.textWith(keysOf(body));
  const LivePicture made = renderer_->still(scene_.read(text), text, frameOf(body));
  const std::vector<std::byte> png = encodePng(made.image);
  return {200, "image/png", {reinterpret_cast<const char*>(png.data()), png.size()}};
}

HttpResponse LiveSession::sceneText(const Json& body) {
  const std::string text = scene_.textWith(keysOf(body));
  const Scene scene = scene_.read(text);
  Json changes = Json::array();
  for (const LiveScene::Change& change : scene_.changes(text))
    changes.push_back({{"key", change.key}, {"from", change.from}, {"to", change.to}});
  return jsonResponse({{"text", text},
                       {"pose", poseToml(scene)},
                       {"changes", changes},
                       {"values", keyValues(scene)},
                       {"sector", sectorJson(scene)}});
}

HttpResponse LiveSession::save(const Json& body) {
  const std::string name = body.value("name", "");
  if (!isSceneName(name))
    throw SceneError("name: accepted: letters, digits, - _ and . without folders, ending in .toml");
  const std::string text = scene_.textWith(keysOf(body));
  scene_.read(text);
  const std::filesystem::path path = scene_.file().parent_path() / name;
  const auto bytes = std::as_bytes(std::span(text));
  if (body.value("replace", false))
    writeFileWhole(path, bytes);
  else if (!writeFileOnce(path, bytes))
    return lineResponse(409, fmt::format("{} exists already", name));
  return jsonResponse({{"saved", path.string()}});
}

HttpResponse LiveSession::view(const Json& body) {
  const std::string key = body.value("view", "");
  const std::optional<View> view = viewOf(key);
  if (!view) throw SceneError(fmt::format("view: \"{}\" is not a standard view", key));
  Scene scene = scene_.read(scene_.textWith(keysOf(body)));
  ViewPlacement placement;
  placement.view = *view;
  placement.place = {"", 0, "view"};
  scene.view = placement;
  return jsonResponse({{"view", keyOf(*view)}, {"keys", poseJson(placed(scene))}});
}

HttpResponse LiveSession::truth(const Json& body) {
  const std::string text = scene_.textWith(keysOf(body));
  const Scene scene = scene_.read(text);
  Json contours = Json::array();
  for (const Contour& contour : renderer_->contours(scene, text, frameOf(body))) {
    Json points = Json::array();
    for (const Vec3d p : contour.points_m)
      points.push_back({std::round(1e5 * p.x) / 1e2, std::round(1e5 * p.z) / 1e2});
    contours.push_back(
        {{"structure", index(contour.surface)}, {"closed", contour.closed}, {"points_mm", points}});
  }
  return jsonResponse({{"frame", frameOf(body)}, {"contours", contours}});
}

HttpResponse LiveSession::effects(const Json& body) {
  const std::string text = scene_.textWith(keysOf(body));
  const Scene scene = scene_.read(text);
  const Simulator& simulator = renderer_->prepared(scene, text);
  Json decisions = Json::array(), stages = Json::object();
  for (const EffectDecision& decision : simulator.plan().effects.decisions)
    if (decision.effect != Effect::channel)
      decisions.push_back(
          {{"name", decision.name()}, {"on", decision.on}, {"reason", decision.reason}});
  const int frames = std::max(1, simulator.tracedFrames());
  const std::array<double, kStages> spent_ms = simulator.clock().milliseconds();
  for (std::size_t s = 0; s < kStages; ++s)
    stages[stageName(static_cast<Stage>(s))] = spent_ms[s] / frames;
  return jsonResponse({{"effects", decisions}, {"stage_ms", stages}});
}

// A scene for each pose at which the probe came to rest.
void LiveSession::record(const std::string& text) {
  if (record_folder_.empty() || text == recorded_) return;
  recorded_ = text;
  const std::filesystem::path path = record_folder_ / fmt::format("pose_{:05}.toml", records_++);
  writeFileWhole(path, std::as_bytes(std::span(text)));
}

}  // namespace echocine::live
