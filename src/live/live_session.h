#pragma once
// A session: requests in, responses or jobs out. No sockets.

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "live/access.h"
#include "live/job_queue.h"
#include "live/live_subject.h"

namespace echocine::live {

class LiveSession {
 public:
  // Reads scene and meshes and makes the page. Runs inside withThreads(). Throws SceneError and
  // JobError.
  LiveSession(const std::filesystem::path& scene_file, std::filesystem::path record_folder);
  // `heart_truth`: the truth.json of a parametric heart whose meshes are in memory; empty: none.
  LiveSession(LiveScene scene, std::filesystem::path record_folder,
              const std::string& heart_truth = {});
  ~LiveSession();

  // Warnings about the scene, a line each.
  const std::vector<std::string>& warnings() const { return warnings_; }

  // Decides on a request that has passed refusalOf(): a response at once (the page, and refusals
  // of what is no valid request: 400, 404), or a job. Jobs answer 422 with one line for a key or a
  // value that the scene refuses, and 410 for a heart that is not kept any more. Jobs refer to the
  // session. Those of a lane run one at a time, those of both lanes beside each other.
  std::variant<HttpResponse, LiveJob> answer(const HttpRequest& request);

 private:
  using Json = nlohmann::ordered_json;
  // The heart of a request, its text with the request's keys, and both as a scene.
  struct Asked {
    std::shared_ptr<Subject> subject;
    std::string text;
    Scene scene;
  };
  std::shared_ptr<Subject> subjectOf(const Json& body);
  Asked asked(const Json& body);

  HttpResponse picture(const Json& body);
  HttpResponse png(const Json& body);
  HttpResponse loop(const Json& body);
  HttpResponse sceneText(const Json& body);
  HttpResponse save(const Json& body);
  HttpResponse view(const Json& body);
  HttpResponse truth(const Json& body);
  HttpResponse effects(const Json& body);
  HttpResponse cost(const Json& body);
  HttpResponse heart(const Json& body);

  // The text as a file in `folder`, to which it refers to its meshes. The meshes of another heart,
  // and of a heart in memory, are written into `heart_folder` of it, unless they are there.
  std::string textFor(const Subject& subject, const std::string& text,
                      const std::filesystem::path& folder, const std::string& heart_folder) const;
  void record(const Asked& asked);

  std::shared_ptr<Subject> own_;
  std::optional<HeartDials> dials_;  // of a parametric heart
  SceneView own_view_;
  Subjects others_;
  std::vector<std::string> warnings_;
  std::string page_;
  std::filesystem::path record_folder_;  // empty: no record
  std::string recorded_;                 // the last recorded text and heart
  int records_ = 0;                      // numbers of poses that are taken
};

}  // namespace echocine::live
