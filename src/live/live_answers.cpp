// The answers of a session to requests about pictures, truth and files.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "core/digest.h"
#include "core/error.h"
#include "core/file.h"
#include "core/shown_path.h"
#include "core/stage_clock.h"
#include "live/live_body.h"
#include "live/live_loop.h"
#include "live/live_page.h"
#include "live/live_session.h"
#include "live/mesh_paths.h"
#include "live/picture_bytes.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/surfaces/probe_placement.h"
#include "scene/names.h"
#include "scene/probe_pose.h"
#include "scene/view_names.h"
#include "video/cine_writer.h"

namespace echocine::live {

namespace {

namespace fs = std::filesystem;

HttpResponse jsonResponse(const LiveJson& json) {
  return {200, "application/json", json.dump(-1, ' ', false, LiveJson::error_handler_t::replace)};
}

HttpResponse bytesResponse(const char* type, const std::vector<std::byte>& bytes) {
  return {200, type, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
}

// Lists of all structures and phases are no help in a table.
std::string shortened(const std::string& value) {
  constexpr std::size_t kMost = 80;
  return value.size() <= kMost ? value : value.substr(0, kMost) + " ...";
}

LiveJson changesJson(const Subject& subject, const std::string& text) {
  LiveJson changes = LiveJson::array();
  for (const auto& [dial, value] : subject.change.dials)
    changes.push_back({{"key", "heart " + dial}, {"from", ""}, {"to", fmt::format("{:g}", value)}});
  for (const auto& [segment, value] : subject.change.segments)
    changes.push_back({{"key", fmt::format("heart segment {}", segment)},
                       {"from", ""},
                       {"to", fmt::format("{:g}", value)}});
  for (const LiveScene::Change& change : subject.scene.changes(text))
    if (change.key != "structure")
      changes.push_back(
          {{"key", change.key}, {"from", shortened(change.from)}, {"to", shortened(change.to)}});
  return changes;
}

// A word of a command line, as a shell reads it.
std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

// A name in `folder` that is free: "a_heart", "a_heart_2" and so on.
std::string freeFolder(const fs::path& folder, const std::string& name) {
  std::error_code failed;
  for (int i = 1; i < 1000; ++i) {
    const std::string made = i == 1 ? name : fmt::format("{}_{}", name, i);
    if (!fs::exists(folder / made, failed)) return made;
  }
  throw SceneError(fmt::format("{}: exists 999 times", name));
}

// The frame of a request, which may count on into the next rounds of the loop.
int frameIn(const Scene& scene, const LiveJson& body) {
  const int frame = frameOf(body);
  return body.value("wrap", false) ? frame % CardiacClock(scene).frameCount() : frame;
}

}  // namespace

HttpResponse LiveSession::picture(const Json& body) {
  if (body.value("effort", "still") == "moving") {
    const std::shared_ptr<Subject> subject = subjectOf(body);
    const Scene& scene = subject->withPose(keysOf(body));
    const LivePicture made =
        subject->renderer.moving(scene, subject->settings, frameIn(scene, body));
    return {200, "application/octet-stream", pictureBytes(made, scene, Effort::moving)};
  }
  const Asked asked = this->asked(body);
  const LivePicture made =
      asked.subject->renderer.still(asked.scene, asked.text, frameIn(asked.scene, body));
  record(asked);
  return {200, "application/octet-stream", pictureBytes(made, asked.scene, Effort::still)};
}

HttpResponse LiveSession::png(const Json& body) {
  const Asked asked = this->asked(body);
  return bytesResponse(
      "image/png",
      encodePng(asked.subject->renderer.still(asked.scene, asked.text, frameOf(body)).image));
}

HttpResponse LiveSession::loop(const Json& body) {
  const Asked asked = this->asked(body);
  const std::string word = body.value("format", "mp4");
  const AnimationFormat format = *animationFormatOf("loop." + word);
  const std::vector<std::byte> bytes =
      encodeLoop(format, CardiacClock(asked.scene).frameCount(),
                 asked.scene.acquisition.frame_rate_hz, [&](int frame) {
                   return asked.subject->renderer.still(asked.scene, asked.text, frame).image;
                 });
  return bytesResponse(format == AnimationFormat::mp4   ? "video/mp4"
                       : format == AnimationFormat::gif ? "image/gif"
                                                        : "image/webp",
                       bytes);
}

HttpResponse LiveSession::sceneText(const Json& body) {
  const Asked asked = this->asked(body);
  return jsonResponse({{"text", asked.text},
                       {"pose", poseToml(asked.scene)},
                       {"changes", changesJson(*asked.subject, asked.text)},
                       {"values", keyValues(asked.scene)},
                       {"sector", sectorJson(asked.scene)},
                       {"loop", loopJson(asked.scene)}});
}

HttpResponse LiveSession::save(const Json& body) {
  const std::string name = body.value("name", "");
  if (!isSceneName(name))
    throw SceneError("name: accepted: letters, digits, - _ and . without folders, ending in .toml");
  const Asked asked = this->asked(body);
  const fs::path folder = own_->scene.file().parent_path(), path = folder / name;
  const bool replaces = body.value("replace", false);
  std::error_code failed;
  if (!replaces && fs::exists(path, failed))
    return lineResponse(409, fmt::format("{} exists already", name));
  const std::string text = textFor(*asked.subject, asked.text, folder,
                                   freeFolder(folder, name.substr(0, name.size() - 5) + "_heart"));
  const auto bytes = std::as_bytes(std::span(text));
  if (replaces)
    writeFileWhole(path, bytes);
  else if (!writeFileOnce(path, bytes))
    return lineResponse(409, fmt::format("{} exists already", name));
  const std::string whole = fs::absolute(path).lexically_normal().string();
  const std::string loop = whole.substr(0, whole.size() - 5) + "_loop";
  return jsonResponse(
      {{"saved", whole},
       {"command", fmt::format("echocine render {} -o {}", quoted(whole), quoted(loop))}});
}

HttpResponse LiveSession::view(const Json& body) {
  const std::string key = body.value("view", "");
  const std::optional<View> view = viewOf(key);
  if (!view) throw SceneError(fmt::format("view: \"{}\" is not a standard view", key));
  Scene scene = asked(body).scene;
  ViewPlacement placement;
  placement.view = *view;
  placement.place = {"", 0, "view"};
  scene.view = placement;
  const Pose pose = placed(scene).probe.pose;
  return jsonResponse(
      {{"view", keyOf(*view)}, {"keys", poseJson(pose.origin, pose.z_axis, pose.x_axis, scene)}});
}

HttpResponse LiveSession::truth(const Json& body) {
  const Asked asked = this->asked(body);
  Subject& subject = *asked.subject;
  const Simulator& still = subject.renderer.prepared(asked.scene, asked.text);
  const LiveTruth::Layers layers =
      subject.truth.at(still, asked.text, frameOf(body), hasLayer(body, "wall"));
  return {200, "application/octet-stream",
          LiveTruth::bytes(layers, asked.scene, frameOf(body), hasLayer(body, "labels"))};
}

HttpResponse LiveSession::effects(const Json& body) {
  const Asked asked = this->asked(body);
  const Simulator& simulator = asked.subject->renderer.prepared(asked.scene, asked.text);
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

HttpResponse LiveSession::cost(const Json& body) {
  const Asked asked = this->asked(body);
  return jsonResponse({{"ms", asked.subject->renderer.cost_ms(asked.scene, frameOf(body))}});
}

std::string LiveSession::textFor(const Subject& subject, const std::string& text,
                                 const fs::path& folder, const std::string& heart_folder) const {
  const bool in_memory = own_->scene.isInMemory();
  if (in_memory && !dials_)
    throw SceneError(
        "the meshes of this scene are in memory, which a file cannot name: copy the pose");
  if (subject.change.name().empty() && !in_memory)
    return withMeshesFrom(text, own_->scene.file().parent_path(), folder);
  std::error_code failed;
  if (!fs::exists(folder / heart_folder, failed))
    dials_->write(subject.change, folder / heart_folder);
  return HeartDials::withFolder(text, heart_folder + "/");
}

// A scene for each pose at which the probe came to rest. The folder may hold those of earlier
// sessions.
void LiveSession::record(const Asked& asked) {
  // Hearts of other dials may have the same text.
  const std::string pose = asked.text + '\n' + asked.subject->change.name();
  if (record_folder_.empty() || pose == recorded_) return;
  // Equal names are equal hearts, also in another session.
  const std::string all = own_->scene.text() + asked.subject->change.name() +
                          (dials_ ? dials_->json(asked.subject->change).dump() : "");
  const std::string heart = digestOfBytes(std::as_bytes(std::span(all))).substr(0, 16);
  const std::string text = textFor(*asked.subject, asked.text, record_folder_, "heart_" + heart);
  const auto bytes = std::as_bytes(std::span(text));
  while (!writeFileOnce(record_folder_ / fmt::format("pose_{:05}.toml", records_++), bytes)) {
  }
  recorded_ = pose;
}

}  // namespace echocine::live
