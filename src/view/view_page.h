#pragma once
// The page of `echocine view`: where a scene's meshes and its probe are, before it is rendered.

#include <filesystem>
#include <functional>
#include <string>

#include "scene/scene.h"
#include "view/scene_view.h"

namespace echocine {

struct ViewSummary {
  std::size_t structures = 0, triangles_given = 0, triangles_shown = 0;
  std::string sight;  // whether the sector sees any structure, else where the meshes are
};

// Writes one page: meshes over the beat and the sector in 3-D, the first frame's picture, names,
// media, roles and extents. `warn` gets the scene's and the plan's warnings. Throws SceneError and
// JobError as Simulator does, and JobError where the page cannot be written; then nothing is.
ViewSummary writeViewPage(const Scene& scene, const std::filesystem::path& path, int threads,
                          const std::function<void(const std::string&)>& warn,
                          const ViewBudget& budget = {});

}  // namespace echocine
