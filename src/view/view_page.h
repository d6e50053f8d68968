#pragma once
// The page of `echocine view`: a scene's meshes and probe before rendering.

#include <filesystem>
#include <functional>
#include <string>

#include "scene/scene.h"
#include "view/scene_view.h"

namespace echocine {

struct ViewSummary {
  std::size_t structures = 0, triangles_given = 0, triangles_shown = 0;
  std::string sight;  // the visible structures, or the position of the meshes
};

// Writes one page: meshes over the beat and the sector in 3-D, the first frame's picture, names,
// media, roles and extents. `warn` receives the warnings of scene and plan. Throws SceneError and
// JobError like Simulator, and JobError if the page cannot be written; no file remains then.
ViewSummary writeViewPage(const Scene& scene, const std::filesystem::path& path, int threads,
                          const std::function<void(const std::string&)>& warn,
                          const ViewBudget& budget = {});

}  // namespace echocine
