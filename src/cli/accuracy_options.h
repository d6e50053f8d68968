#pragma once
// --preset and --tolerance-db: options that override a scene's accuracy.

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

  // The scene to render, with the record for its manifest. The selection and its reason are printed
  // on standard error. Throws SceneError for contradictory options.
  AccuracyRecord resolve(Scene& scene, int threads, bool quiet) const;

 private:
  std::string preset_;
  std::optional<double> tolerance_db_;
};

}  // namespace echocine
