// Loops against real ones.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "compare/compare.h"
#include "compare/frame_discrepancy.h"
#include "compare/results.h"
#include "core/error.h"
#include "core/output_check.h"
#include "core/parallel.h"
#include "fit/fit_report.h"
#include "motion/surfaces/probe_placement.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/fork_guard.h"
#include "python/job.h"
#include "python/native_scene.h"
#include "python/side_options.h"
#include "python/unlocked.h"

namespace echocine::python {

namespace {

using Path = std::filesystem::path;

// align_space, monotone, contours, knots, knot_count, band_mm.
using CompareDetails = std::tuple<bool, bool, bool, std::vector<double>, int, double>;

// only_check: arguments and place of the results, before a loop is rendered for it.
py::tuple compareFiles(const Path& synthetic, const Path& real, const std::optional<Path>& folder,
                       const py::dict& real_side, const py::dict& synthetic_side,
                       const CompareDetails& details, const std::optional<Path>& scene,
                       double tilt_deg, int threads, bool only_check, const py::object& progress) {
  compare::CompareOptions options;
  options.synthetic = synthetic;
  options.real = real;
  options.real_side = sideOf(real_side, "real");
  options.synthetic_side = sideOf(synthetic_side, "synthetic");
  std::tie(options.align_space, options.monotone, options.contours, options.knots,
           options.knot_count, options.band_mm) = details;
  if (scene) options.scene = *scene;
  options.tilt_deg = tiltOf(tilt_deg);
  if (folder) checkOutputFolder(*folder, {"summary.json"});
  std::string summary, frames;
  if (only_check) return py::make_tuple(summary, frames);
  runJob(progress, [&](const Monitor& monitor) {
    withThreads(threads, [&] {
      const compare::Comparison comparison = compare::compareLoops(options, monitor);
      if (folder) compare::writeResults(comparison, options, *folder);
      summary = compare::summaryJson(comparison)
                    .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
      frames = compare::framesCsv(comparison);
    });
  });
  return py::make_tuple(summary, frames);
}

struct Distance {
  Distance(const echo::EchoLoop& real, const Probe& probe)
      : discrepancy(real, probe), lines(probe.lines), samples(probe.samples) {}
  compare::FrameDiscrepancy discrepancy;
  std::string tilt;  // JSON; empty without
  int lines, samples;
};

std::shared_ptr<Distance> makeDistance(const Path& real, const NativeScene& scene,
                                       const py::dict& side, double tilt_deg) {
  const echo::SideOptions options = sideOf(side, "real");
  const double most_deg = tiltOf(tilt_deg);
  std::shared_ptr<Distance> made;
  runJob(py::none(), [&](const Monitor& monitor) {
    withThreads(0, [&] {
      const echo::EchoLoop loop = echo::readLoop(real, options, true);
      const Scene stands = placed(scene.scene);
      made = std::make_shared<Distance>(loop, stands.probe);
      if (most_deg > 0)
        made->tilt = fit::tiltJson(fit::fitScene(stands, loop, options, most_deg, monitor)).dump();
    });
  });
  return made;
}

// Greys (depth, line); views of frames lie in memory as the tracer made them and are not copied.
double distance(const Distance& d, int frame, const py::array_t<float>& greys) {
  beginWork();
  if (frame < 0 || frame >= d.discrepancy.realFrames())
    throw py::index_error(
        fmt::format("frame: is {}, accepted: 0 to {}", frame, d.discrepancy.realFrames() - 1));
  if (greys.ndim() != 2 || greys.shape(0) != d.samples || greys.shape(1) != d.lines)
    throw py::value_error(
        fmt::format("greys: is {}, accepted: ({}, {}), float32: depth, line of the probe",
                    shown(greys), d.samples, d.lines));
  const auto lines_first =
      py::array_t<float, py::array::c_style | py::array::forcecast>(greys.attr("T"));
  const std::span<const float> values(lines_first.data(),
                                      static_cast<std::size_t>(lines_first.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw py::value_error(fmt::format("greys: holds {} at line {}, sample {}, accepted: 0 to 1",
                                        values[i], i / static_cast<std::size_t>(d.samples),
                                        i % static_cast<std::size_t>(d.samples)));
  const Unlocked released;
  return d.discrepancy(frame, values);
}

}  // namespace

void bindCompare(py::module_& module) {
  module.def("compare", &compareFiles, py::arg("synthetic"), py::arg("real"),
             py::arg("folder").none(true), py::arg("real_side"), py::arg("synthetic_side"),
             py::arg("details"), py::arg("scene").none(true), py::arg("tilt_deg"),
             py::arg("threads"), py::arg("only_check"), py::arg("progress").none(true),
             "summary.json and frames.csv as texts.");
  py::class_<Distance, std::shared_ptr<Distance>>(module, "FrameDiscrepancy",
                                                  "Distance of frames to a real loop.")
      .def(py::init(&makeDistance), py::arg("real"), py::arg("scene"), py::arg("side"),
           py::arg("tilt_deg"))
      .def("__call__", &distance, py::arg("frame"), py::arg("greys"),
           "0 equal, about 1 unrelated: greys (depth, line) float32, 0 to 1.")
      .def_property_readonly(
          "real_frames", [](const Distance& d) { return d.discrepancy.realFrames(); },
          "Frames of the real loop.")
      .def_property_readonly(
          "overlap", [](const Distance& d) { return d.discrepancy.overlapShare(); },
          "Share of the sector that both loops show, 0 to 1.")
      .def_readonly("tilt", &Distance::tilt, "The tilt, as JSON; empty if not requested.");
}

}  // namespace echocine::python
