#include "view/view_page.h"

#include <nlohmann/json.hpp>

#include "core/output_check.h"
#include "core/parallel.h"
#include "core/shown_path.h"
#include "motion/cycle/cardiac_clock.h"
#include "page/assets.h"
#include "page/page.h"
#include "plan/loop_plan.h"
#include "scene/scene_json.h"
#include "video/cine_writer.h"
#include "view/view_json.h"

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

// With a picture, and without what costs time and is not looked at.
Scene withPicture(Scene scene) {
  scene.output.cine = true;
  scene.output.channels = {Channel::y};
  scene.truth = {};
  return scene;
}

// "beating_heart/scene.toml": most scene files are called the same.
std::string titleOf(const Scene& scene) {
  const std::filesystem::path file = std::filesystem::absolute(scene.file).lexically_normal();
  return (file.parent_path().filename() / file.filename()).string();
}

// Frames of the loop's first beat.
Json framesJson(const CardiacClock& clock) {
  int count = 0;
  while (count < clock.frameCount() && clock.at(count).beat == 0) ++count;
  const int stride = pageStride(count);
  Json frames{{"index", Json::array()}, {"time_s", Json::array()}, {"phase", Json::array()}};
  for (int i = 0; i < count; i += stride) {
    const FrameTime time = clock.at(i);
    frames["index"].push_back(i);
    frames["time_s"].push_back(time.time_s);
    frames["phase"].push_back(time.phase);
  }
  frames["stride"] = stride;
  return frames;
}

PageLook lookOf(const Scene& scene) {
  PageLook look{"EchoCine view: " + titleOf(scene),
                {pageAsset("page.css"), pageAsset("heart_view.css")},
                pageAsset("view.html"),
                {pageAsset("page.js"), pageAsset("player.js")}};
  const std::vector<std::string_view> drawing = heartViewScripts();
  look.scripts.insert(look.scripts.end(), drawing.begin(), drawing.end());
  look.scripts.push_back(pageAsset("view.js"));
  return look;
}

// A page may be passed on, so it names no folders.
Json shownWarnings(const Scene& scene, const LoopPlan& plan) {
  Json shown = Json::array();
  for (const std::vector<std::string>& warnings : {scene.warnings, plan.warnings})
    for (const std::string& warning : warnings)
      shown.push_back(withoutFolders(warning, scene.file.parent_path()));
  return shown;
}

ViewSummary summaryOf(const SceneView& view) {
  ViewSummary summary;
  summary.structures = view.structures.size();
  summary.sight = view.sight;
  for (const ViewStructure& s : view.structures) {
    summary.triangles_given += s.triangles_given;
    summary.triangles_shown += s.mesh.triangles.size();
  }
  return summary;
}

}  // namespace

ViewSummary writeViewPage(const Scene& given, const std::filesystem::path& path, int threads,
                          const std::function<void(const std::string&)>& warn,
                          const ViewBudget& budget) {
  checkOutputFile(path);
  for (const std::string& warning : given.warnings) warn(warning);
  ViewSummary summary;
  withThreads(threads, [&] {
    const Simulator simulator(withPicture(given));
    for (const std::string& warning : simulator.plan().warnings) warn(warning);
    const Scene& scene = simulator.scene();
    const Frame frame = simulator.frame(0);
    const SceneView view = viewScene(simulator, budget);
    PageWriter writer(path, lookOf(scene));  // last: a signal before leaves nothing behind
    writer.addFrame("slice", encodePng(frame.image));
    writer.finish({{"version", ECHOCINE_VERSION},
                   {"title", titleOf(scene)},
                   {"background", scene.medium(scene.background).name},
                   {"acquisition", sceneJson(scene)["acquisition"]},
                   {"probe", sceneJson(scene)["probe"]},
                   {"warnings", shownWarnings(given, simulator.plan())},
                   {"frames", framesJson(simulator.cardiacClock())},
                   {"view", viewJson(view, scene)}});
    summary = summaryOf(view);
  });
  return summary;
}

}  // namespace echocine
