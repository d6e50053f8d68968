#pragma once
// A session: requests in, responses or jobs out. No sockets.

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>

#include "live/access.h"
#include "live/job_queue.h"
#include "live/live_renderer.h"
#include "live/live_scene.h"

namespace echocine::live {

class LiveSession {
 public:
  // Reads scene and meshes and makes the page. Runs inside withThreads(). Throws SceneError and
  // JobError.
  LiveSession(const std::filesystem::path& scene_file, std::filesystem::path record_folder);
  ~LiveSession();

  // Warnings about the scene, a line each.
  const std::vector<std::string>& warnings() const { return warnings_; }

  // Decides on a request that has passed refusalOf(): a response at once (the page, and refusals
  // of what is no valid request: 400, 404), or a job. Jobs answer 422 with one line for a key or a
  // value that the scene refuses. Jobs refer to the session and run one at a time.
  std::variant<HttpResponse, LiveJob> answer(const HttpRequest& request);

 private:
  using Json = nlohmann::ordered_json;
  struct Routes;
  HttpResponse picture(const Json& body);
  HttpResponse png(const Json& body);
  HttpResponse sceneText(const Json& body);
  HttpResponse save(const Json& body);
  HttpResponse view(const Json& body);
  HttpResponse truth(const Json& body);
  HttpResponse effects(const Json& body);
  void record(const std::string& text);
  const Scene& withPose(const Json& keys);

  LiveScene scene_;
  std::unique_ptr<LiveRenderer> renderer_;
  std::vector<std::string> warnings_;
  std::string page_;
  std::filesystem::path record_folder_;  // empty: no record
  std::string recorded_;                 // the last recorded text
  std::string settings_;                 // keys but the pose, of the last moving picture
  std::optional<Scene> scene_of_settings_;
  int records_ = 0;
};

}  // namespace echocine::live
