#pragma once
// The hearts of a session: the scene's own meshes, and others that its dials make.

#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "live/heart_dials.h"
#include "live/live_renderer.h"
#include "live/live_scene.h"
#include "live/live_truth.h"
#include "view/scene_view.h"

namespace echocine::live {

// One at a time uses it, as its renderer.
struct Subject {
  explicit Subject(LiveScene given);

  LiveScene scene;
  HeartChange change;  // empty: the scene's own meshes
  LiveRenderer renderer;
  LiveTruth truth;
  // Keys but the pose, and scene, of the last moving picture.
  std::string settings;
  std::optional<Scene> scene_of_settings;

  // The scene of a moving picture. Without a change of settings only the pose is read anew.
  const Scene& withPose(const nlohmann::ordered_json& keys);
};

// The hearts that were used last. Thread-safe.
class Subjects {
 public:
  // Our choice: the one that is shown, the one before it, and that of another page.
  static constexpr std::size_t kKept = 3;

  std::shared_ptr<Subject> find(const std::string& name);  // null: not kept
  void keep(const std::string& name, std::shared_ptr<Subject> subject);

 private:
  std::mutex mutex_;
  std::list<std::pair<std::string, std::shared_ptr<Subject>>> kept_;  // the last used one first
};

}  // namespace echocine::live
