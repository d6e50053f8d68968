// The commands plan and study as calls; JSON texts come back, as the commands write them.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "motion/surfaces/probe_placement.h"
#include "python/bindings.h"
#include "python/job.h"
#include "python/native_scene.h"
#include "render/estimate.h"
#include "study/study.h"
#include "study/study_files.h"
#include "study/study_folder.h"
#include "study/tolerance.h"

namespace echocine::python {

namespace {

std::string plan(const NativeScene& scene, int threads, const py::object& progress) {
  nlohmann::ordered_json json;
  runJob(progress, [&](const Monitor& monitor) {
    const Scene wanted = atOwnTolerance(placed(scene.scene), threads, monitor).scene;
    json = estimateJson(wanted, estimateLoop(wanted, threads, monitor));
  });
  return json.dump();
}

void refuseUnknown(const std::vector<std::string>& knobs) {
  const std::vector<std::string> known = knobNames();
  for (const std::string& knob : knobs)
    if (std::find(known.begin(), known.end(), knob) == known.end())
      throw SceneError(
          fmt::format("knobs: \"{}\" is not a knob, accepted: {}", knob, fmt::join(known, ", ")));
}

std::string study(const NativeScene& scene, const std::optional<std::filesystem::path>& folder,
                  int frames, int repeats, const std::vector<std::string>& knobs,
                  std::optional<double> budget_s, int threads, const py::object& progress) {
  refuseUnknown(knobs);
  StudyOptions options;
  options.threads = threads;
  options.frames = frames;
  options.repeats = repeats;
  options.knobs = knobs;
  if (folder) options.folder = *folder;
  if (budget_s) options.budget_s = *budget_s;
  std::optional<StudyFolder> files;
  if (folder) files.emplace(*folder);
  const auto write = [&](const StudyResult& result, bool last) {
    if (files) files->write(result, last);
  };
  std::string json;
  runJob(progress, [&](const Monitor& monitor) {
    const StudyResult result =
        runStudy(scene.scene, options, monitor, [&](const StudyResult& r) { write(r, false); });
    if (result.rows.empty()) throw JobError("stopped before the first setting was measured");
    write(result, true);
    json = studyJson(result).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  });
  return json;
}

}  // namespace

void bindPlan(py::module_& module) {
  module.def("plan", &plan, py::arg("scene"), py::arg("threads"), py::arg("progress").none(true),
             "The effects that a loop needs, reasons and expected cost, as JSON.");
  module.def("study", &study, py::arg("scene"), py::arg("folder").none(true), py::arg("frames"),
             py::arg("repeats"), py::arg("knobs"), py::arg("budget_s").none(true),
             py::arg("threads"), py::arg("progress").none(true),
             "Image error against computing time, as JSON.");
}

}  // namespace echocine::python
