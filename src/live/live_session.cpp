#include "live/live_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/output_check.h"
#include "live/live_body.h"
#include "live/live_page.h"
#include "view/view_json.h"

namespace echocine::live {

namespace {

// A heart that was asked for again under its name may have been left out.
struct GoneError {};

}  // namespace

LiveSession::LiveSession(const std::filesystem::path& scene_file,
                         std::filesystem::path record_folder)
    : LiveSession(LiveScene(scene_file), std::move(record_folder)) {}

LiveSession::LiveSession(LiveScene given, std::filesystem::path record_folder,
                         const std::string& heart_truth)
    : own_(std::make_shared<Subject>(std::move(given))), record_folder_(std::move(record_folder)) {
  const LiveScene& live = own_->scene;
  const Scene scene = live.read(live.text());
  if (!live.isInMemory() || !heart_truth.empty())
    dials_ = HeartDials::of(scene, live.text(), heart_truth);
  if (!record_folder_.empty() && live.isInMemory() && !dials_)
    throw SceneError("record: the meshes of this scene are in memory, which files cannot name");
  if (!record_folder_.empty()) {
    makeFolder(record_folder_);
    checkOutputFile(record_folder_ / "pose");
  }
  const Simulator& simulator = own_->renderer.prepared(scene, live.text());
  warnings_ = scene.warnings;
  warnings_.insert(warnings_.end(), simulator.plan().warnings.begin(),
                   simulator.plan().warnings.end());
  own_view_ = viewScene(simulator);
  page_ = pageOf(simulator, own_view_, live, dials_ ? &*dials_ : nullptr);
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
  constexpr Route kRoutes[] = {
      {"/picture", &LiveSession::picture}, {"/png", &LiveSession::png},
      {"/loop", &LiveSession::loop},       {"/scene", &LiveSession::sceneText},
      {"/save", &LiveSession::save},       {"/view", &LiveSession::view},
      {"/truth", &LiveSession::truth},     {"/effects", &LiveSession::effects},
      {"/cost", &LiveSession::cost},       {"/heart", &LiveSession::heart}};
  const auto* route = std::find_if(std::begin(kRoutes), std::end(kRoutes),
                                   [&](const Route& r) { return request.path == r.path; });
  if (route == std::end(kRoutes)) return lineResponse(404, "not found");
  std::optional<Json> read = jsonOf(request.body);
  if (!read) return lineResponse(400, "the body is not JSON, or is nested too deeply");
  Json& body = *read;
  if (const std::string fault = faultOf(body); !fault.empty()) return lineResponse(400, fault);
  LiveJob job;
  const bool makes_heart = request.path == "/heart";
  job.picture = makes_heart || request.path == "/picture";
  job.gives_way = makes_heart || (job.picture && body.value("effort", "still") == "still");
  if (makes_heart) job.lane = Lane::hearts;
  job.run = [this, answer = route->answer, body = std::move(body)] {
    try {
      return (this->*answer)(body);
    } catch (const SceneError& error) {
      return lineResponse(422, error.what());
    } catch (const GoneError&) {
      return lineResponse(410, "this heart is not kept any more: set its dials again");
    }
  };
  return job;
}

std::shared_ptr<Subject> LiveSession::subjectOf(const Json& body) {
  const HeartChange change = heartChangeOf(body);
  const std::string name = change.name();
  if (name.empty()) return own_;
  std::shared_ptr<Subject> subject = others_.find(name);
  if (!subject) throw GoneError();
  return subject;
}

LiveSession::Asked LiveSession::asked(const Json& body) {
  std::shared_ptr<Subject> subject = subjectOf(body);
  std::string text = subject->scene.textWith(keysOf(body));
  Scene scene = subject->scene.read(text);
  return {std::move(subject), std::move(text), std::move(scene)};
}

// Runs beside the pictures: touches nothing of theirs.
HttpResponse LiveSession::heart(const Json& body) {
  if (!dials_) throw SceneError("dials: the meshes of this scene are not a parametric heart's");
  const HeartChange change = heartChangeOf(body);
  const heart::ProbePose& before = dials_->ownStandard();
  const LiveScene& live = own_->scene;
  heart::ProbePose standard = before;
  Json structures;
  const Scene own = live.read(live.text());
  if (change.name().empty()) {
    structures = viewJson(own_view_, own)["structures"];
  } else {
    OtherHeart other = dials_->made(change, live.text());
    standard = other.standard;
    auto subject =
        std::make_shared<Subject>(LiveScene(live, std::move(other.text), std::move(other.meshes)));
    subject->change = change;
    const Scene scene = subject->scene.read(subject->scene.text());
    const SceneView view = viewScene(scene, subject->renderer.motion(), {}, &own_view_);
    structures = viewJson(view, scene)["structures"];
    others_.keep(change.name(), std::move(subject));
  }
  const auto poseOf = [&](const heart::ProbePose& pose) {
    return poseJson(pose.apex, pose.axis, pose.lateral, own);
  };
  return {200, "application/json",
          Json({{"structures", structures},
                {"heart", dials_->json(change)},
                {"standard", poseOf(standard)},
                {"own_standard", poseOf(before)}})
              .dump(-1, ' ', false, Json::error_handler_t::replace)};
}

}  // namespace echocine::live
