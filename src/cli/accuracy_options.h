#pragma once
// --preset and --tolerance-db: who sets a scene's accuracy, if not the scene.

#include <optional>
#include <string>

#include "output/accuracy_record.h"
#include "scene/scene.h"

namespace CLI {
class App;
}

namespace echocine {

class AccuracyOptions {
 public:
  void addTo(CLI::App& command);

  // The scene as it is to be rendered, with the record for its manifest. What was picked, and why,
  // is a line on standard error. Throws SceneError when two demands contradict each other.
  AccuracyRecord resolve(Scene& scene, int threads, bool quiet) const;

 private:
  std::string preset_;
  std::optional<double> tolerance_db_;
};

}  // namespace echocine
