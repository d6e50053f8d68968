#include "live/live_subject.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "live/live_body.h"

namespace echocine::live {

Subject::Subject(LiveScene given) : scene(std::move(given)), renderer(scene.read(scene.text())) {}

const Scene& Subject::withPose(const LiveJson& keys) {
  LiveJson others = LiveJson::object(), pose = LiveJson::object();
  for (const auto& [key, value] : keys.items()) (isPoseKey(key) ? pose : others)[key] = value;
  const std::string name = others.dump(-1, ' ', true, LiveJson::error_handler_t::replace);
  const std::optional<Pose> quick =
      scene_of_settings && pose.size() == 3 ? poseFrom(pose, *scene_of_settings) : std::nullopt;
  if (settings != name || !quick) {
    scene_of_settings = scene.read(scene.textWith(keys));
    settings = name;
  } else {
    scene_of_settings->probe.pose = *quick;
  }
  return *scene_of_settings;
}

std::shared_ptr<Subject> Subjects::find(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  if (found == kept_.end()) return nullptr;
  kept_.splice(kept_.begin(), kept_, found);
  return found->second;
}

void Subjects::keep(const std::string& name, std::shared_ptr<Subject> subject) {
  const std::lock_guard lock(mutex_);
  std::erase_if(kept_, [&](const auto& entry) { return entry.first == name; });
  kept_.emplace_front(name, std::move(subject));
  if (kept_.size() > kKept) kept_.pop_back();
}

}  // namespace echocine::live
