// A heart fitted to files of loops.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/error.h"
#include "core/parallel.h"
#include "fit/fit_files.h"
#include "fit/fit_results.h"
#include "motion/heart/heart_poses.h"
#include "python/bindings.h"
#include "python/job.h"
#include "python/side_options.h"

namespace echocine::python {

namespace {

using Path = std::filesystem::path;

std::optional<heart::View> fitViewOf(const std::optional<std::string>& key) {
  if (!key) return std::nullopt;
  if (const auto view = heart::viewOf(*key)) return view;
  std::string accepted;
  for (const heart::ViewName& name : heart::viewNames())
    accepted += fmt::format("{}\"{}\"", accepted.empty() ? "" : ", ", name.key);
  throw py::value_error(fmt::format("loops: \"{}\" is not a view, accepted: {}", *key, accepted));
}

// (fit.json, curves.csv, dials of the heart)
py::tuple fitLoops(const std::vector<std::tuple<std::optional<std::string>, Path, py::dict>>& loops,
                   const std::optional<Path>& folder, const std::map<std::string, double>& dials,
                   const std::optional<std::vector<std::string>>& searched, double tilt_deg,
                   int starts, int descents, std::optional<bool> own_look, bool own_loops,
                   int resamples, const std::optional<Path>& cache, bool resume, int threads,
                   const py::object& progress) {
  std::vector<fit::FitFile> files;
  for (const auto& [view, file, side] : loops)
    files.push_back({fitViewOf(view), file, sideOf(side, "side")});
  fit::HeartFitOptions options;
  options.dials = dials;
  if (searched) options.searched = *searched;
  options.tilt_deg = tiltOf(tilt_deg);
  options.starts = starts;
  options.descents = descents;
  options.own_look = own_look;
  options.own_loops = own_loops;
  options.resamples = resamples;
  options.heart_cache = cache.value_or(Path{});
  std::string text, curves;
  std::map<std::string, double> found;
  runJob(progress, [&](const Monitor& monitor) {
    withThreads(threads, [&] {
      const fit::FittedFiles made = fitFiles(files, options, folder, monitor, resume);
      text = fit::fitText(made.fit, made.labels);
      if (made.fit.ef) curves = fit::curvesCsv(made.fit);
      found = made.fit.dials;
    });
  });
  return py::make_tuple(text, curves, found);
}

}  // namespace

void bindHeartFit(py::module_& module) {
  module.def("fit", &fitLoops, py::arg("loops"), py::arg("folder").none(true), py::arg("dials"),
             py::arg("searched").none(true), py::arg("tilt_deg"), py::arg("starts"),
             py::arg("descents"), py::arg("own_look").none(true), py::arg("own_loops"),
             py::arg("resamples"), py::arg("cache").none(true), py::arg("resume"),
             py::arg("threads"), py::arg("progress").none(true),
             "fit.json and curves.csv as texts, and the dials.");
  module.def(
      "heart_cache", [] { return fit::userHeartCache(); }, "The user's folder of hearts.");
}

}  // namespace echocine::python
