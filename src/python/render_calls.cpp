// The command render as a call: a loop into a folder.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/error.h"
#include "core/output_check.h"
#include "motion/surfaces/probe_placement.h"
#include "python/bindings.h"
#include "python/job.h"
#include "python/native_scene.h"
#include "render/render.h"
#include "study/tolerance.h"

namespace echocine::python {

namespace {

void renderToFolder(const NativeScene& scene, const std::filesystem::path& folder,
                    const std::optional<std::pair<int, int>>& frames, int threads, bool resume,
                    bool overwrite, const py::object& progress) {
  RenderOptions options{.folder = folder,
                        .threads = threads,
                        .frames = frames,
                        .resume = resume,
                        .overwrite = overwrite};
  runJob(progress, [&](const Monitor& monitor) {
    checkOutputFolder(folder, {"manifest.json"});
    AccuracyChoice choice = atOwnTolerance(placed(scene.scene), threads, monitor);
    options.accuracy = std::move(choice.record);
    const RenderSummary summary = renderLoop(choice.scene, options, monitor);
    if (summary.frames_done < summary.frames_wanted)
      throw JobError(fmt::format(
          "stopped: {} of {} frames are finished in {}; resume=True continues from there",
          summary.frames_done, summary.frames_wanted, folder.string()));
  });
}

}  // namespace

void bindRender(py::module_& module) {
  module.def("render_to_folder", &renderToFolder, py::arg("scene"), py::arg("folder"),
             py::arg("frames").none(true), py::arg("threads"), py::arg("resume"),
             py::arg("overwrite"), py::arg("progress").none(true), "A loop as files.");
}

}  // namespace echocine::python
