#pragma once
// echocine live: a session served on this machine until it is stopped.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "scene/scene_reader.h"

namespace echocine::live {

struct LiveOptions {
  std::filesystem::path scene;
  std::optional<std::string> text;  // of the scene, in place of the file's
  NamedMeshes meshes;               // of that text; empty: in files
  std::string heart_truth;          // truth.json of these meshes; empty: no parametric heart
  std::filesystem::path record;     // folder for a scene of each pose at rest; empty: none
  int port = 0;                     // 0: any free one
  int threads = 0;                  // 0: one per core
  bool framed = false;  // other pages of this machine, such as a notebook, may show the page
};

// Serves the scene on 127.0.0.1 until `stop` is true, which is polled every 50 ms and must be
// thread-safe. `listening` is called once with the link of the page, `warn` with each warning about
// the scene. Throws SceneError and JobError, also if the port is taken, and Stopped before the page
// is served.
void serveLive(const LiveOptions& options,
               const std::function<void(const std::string& link)>& listening,
               const std::function<void(const std::string&)>& warn,
               const std::function<bool()>& stop);

}  // namespace echocine::live
