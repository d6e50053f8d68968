// Models of hearts in their imaging plane, for comparisons with a real loop.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <tuple>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "fit/dial_checks.h"
#include "fit/dial_grid.h"
#include "fit/fit_cost.h"
#include "fit/heart_family.h"
#include "fit/model_discrepancy.h"
#include "fit/searched_dials.h"
#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/probe_placement.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/job.h"
#include "python/native_scene.h"
#include "python/side_options.h"

namespace echocine::python {

namespace {

using Model = std::shared_ptr<fit::ModelLoop>;
using Ranges = std::vector<std::tuple<std::string, double, double>>;
using Dials = std::map<std::string, double>;

// As many as a fit can search.
constexpr std::size_t kMostRanges = 16;

fit::Focus focusFrom(const std::string& word) {
  if (word == "all") return fit::Focus::all;
  if (word == "left_ventricle") return fit::Focus::left_ventricle;
  throw py::value_error(
      fmt::format("focus: is \"{}\", accepted: \"all\" | \"left_ventricle\"", word));
}

std::shared_ptr<fit::HeartFamily> makeFamily(const Ranges& ranges, const std::string& view_key,
                                             const Dials& dials, std::optional<int> nodes,
                                             double tilt_deg,
                                             const std::optional<std::filesystem::path>& cache,
                                             int threads, const py::object& progress) {
  const heart::View view = viewFrom("view", view_key);
  tiltOf(tilt_deg);
  std::vector<fit::DialRange> by_key;
  for (const auto& [key, low, high] : ranges) by_key.push_back({key, low, high});
  if (by_key.size() > kMostRanges)
    throw SceneError(
        fmt::format("ranges: holds {}, accepted: up to {}", by_key.size(), kMostRanges));
  std::shared_ptr<fit::HeartFamily> family;
  runJob(progress, [&](const Monitor& monitor) {
    withThreads(threads, [&] {
      if (nodes || by_key.size() <= fit::kMostAxes) {
        family = std::make_shared<fit::HeartFamily>(dials, by_key, view, fit::kFitFrames,
                                                    nodes.value_or(fit::nodesFor(by_key.size())),
                                                    monitor, tilt_deg);
        return;
      }
      fit::HeartCache kept;
      if (cache) kept = fit::HeartCache(*cache, fit::kMostCacheBytes, monitor.warn);
      const fit::HeartNodes hearts(dials, fit::HeartDesign::polynomial(by_key), fit::kFitFrames,
                                   monitor, std::move(kept));
      family = std::make_shared<fit::HeartFamily>(hearts, view, monitor, tilt_deg);
    });
  });
  return family;
}

Model modelAt(const fit::HeartFamily& family, const Doubles& values, double tilt_deg,
              double rotate_deg, const std::string& focus_word, int threads) {
  if (values.ndim() != 1)
    throw py::value_error(fmt::format("values: is {}, accepted: ({},), float64", shown(values),
                                      family.ranges().size()));
  const std::vector<double> places(values.data(), values.data() + values.size());
  const fit::Focus focus = focusFrom(focus_word);
  Model model;
  runJob(py::none(), [&](const Monitor&) {
    withThreads(threads, [&] {
      model = std::make_shared<fit::ModelLoop>(family.at(
          places,
          {.tilt_rad = radiansFromDegrees(tilt_deg), .rotate_rad = radiansFromDegrees(rotate_deg)},
          focus));
    });
  });
  return model;
}

Model modelOf(const NativeScene& native, const std::string& focus_word, int threads) {
  const fit::Focus focus = focusFrom(focus_word);
  Model model;
  runJob(py::none(), [&](const Monitor&) {
    withThreads(threads, [&] {
      const Scene scene = placed(native.scene);
      model = std::make_shared<fit::ModelLoop>(
          fit::modelLoop(scene, MeshMotion(scene), fit::kFitFrames, {}, focus));
    });
  });
  return model;
}

py::array tissuePlanes(const fit::ModelLoop& model) {
  py::array_t<std::uint8_t> out({static_cast<py::ssize_t>(model.frames.size()),
                                 static_cast<py::ssize_t>(model.cells_across),
                                 static_cast<py::ssize_t>(model.cells_along)});
  std::uint8_t* to = out.mutable_data();
  for (const fit::ModelFrame& frame : model.frames)
    for (const fit::TissueCell& cell : frame.cells)
      *to++ = cell.share < 0.5f ? cell.second : cell.first;
  return out;
}

// Centres of the cells, (across, along, 2): x and z, mm.
py::array cellPlaces(const fit::ModelLoop& model) {
  py::array_t<float> out({static_cast<py::ssize_t>(model.cells_across),
                          static_cast<py::ssize_t>(model.cells_along), py::ssize_t{2}});
  float* to = out.mutable_data();
  for (const fit::TissueCell& cell : model.frames.front().cells) {
    *to++ = 1e3f * cell.x_m;
    *to++ = 1e3f * cell.z_m;
  }
  return out;
}

py::tuple boundaryOf(const fit::ModelLoop& model, int frame) {
  const int frames = static_cast<int>(model.frames.size());
  if (frame < 0 || frame >= frames)
    throw py::index_error(fmt::format("frame: is {}, accepted: 0 to {}", frame, frames - 1));
  const auto& pieces = model.frames[static_cast<std::size_t>(frame)].boundary;
  const auto count = static_cast<py::ssize_t>(pieces.size());
  py::array_t<float> points({count, py::ssize_t{2}});
  py::array_t<std::uint16_t> structures(count);
  for (py::ssize_t i = 0; i < count; ++i) {
    const fit::BoundaryPoint& piece = pieces[static_cast<std::size_t>(i)];
    points.mutable_at(i, 0) = 1e3f * piece.x_m;
    points.mutable_at(i, 1) = 1e3f * piece.z_m;
    structures.mutable_at(i) = piece.surface;
  }
  return py::make_tuple(points, structures);
}

py::list rangesOf(const fit::HeartFamily& family) {
  py::list out;
  for (const fit::DialRange& range : family.ranges())
    out.append(py::make_tuple(range.key, range.low, range.high));
  return out;
}

// Log of the prior density of the given dials; other dials of a heart have their defaults.
double logDensity(const fit::HeartPrior& prior, const Dials& dials) {
  double out = 0;
  for (const auto& [key, value] : dials) {
    fit::checkDial("dials", fit::dialOf("dials", key), value);
    if (const fit::LonePrior* lone = fit::lonePriorOf(key)) out += lone->logDensity(value);
  }
  Dials heart = dials;
  fit::addFollowers(heart);
  return out + prior.logDensity(fit::priorDialsOf(heart));
}

Dials byKey(const fit::PriorDials& values) {
  Dials out;
  for (std::size_t i = 0; i < values.size(); ++i) out[fit::kPriorDials[i]] = values[i];
  return out;
}

Dials drawFrom(const fit::HeartPrior& prior, std::uint64_t seed, std::uint64_t number) {
  return byKey(fit::HeartPrior::dialsOf(prior.draw(seed, number)));
}

Dials meanOf(const fit::HeartPrior& prior) {
  Dials out = byKey(prior.mean());
  for (const fit::LonePrior& lone : fit::kLonePriors) out[lone.key] = lone.median;
  return out;
}

Dials sdOf(const fit::HeartPrior& prior) {
  Dials out;
  for (const auto& [key, mean] : meanOf(prior)) out[key] = prior.sdOf(key).value();
  return out;
}

}  // namespace

void bindModels(py::module_& module) {
  py::class_<fit::HeartFamily, std::shared_ptr<fit::HeartFamily>>(
      module, "HeartFamily", "Parametric hearts interpolated between computed ones.")
      .def(py::init(&makeFamily), py::arg("ranges"), py::arg("view"), py::arg("dials"),
           py::arg("nodes").none(true), py::arg("tilt_deg"), py::arg("cache").none(true),
           py::arg("threads"), py::arg("progress").none(true))
      .def("at", &modelAt, py::arg("values"), py::arg("tilt_deg"), py::arg("rotate_deg"),
           py::arg("focus"), py::arg("threads"), "The beat of one heart.")
      .def_property_readonly("ranges", &rangesOf, "Key, least and most of each range.")
      .def_property_readonly("nodes", &fit::HeartFamily::nodes,
                             "Computed hearts per range; 0: those of a polynomial.");
  py::class_<fit::ModelLoop, std::shared_ptr<fit::ModelLoop>>(
      module, "ModelLoop", "A beat of a model in its imaging plane.")
      .def(py::init(&modelOf), py::arg("scene"), py::arg("focus"), py::arg("threads"))
      .def_readonly("tissues", &fit::ModelLoop::tissues, "Media by number.")
      .def_readonly("structures", &fit::ModelLoop::structures, "Structures by number.")
      .def_readonly("systole", &fit::ModelLoop::systole, "End-systole, a fraction of the beat.")
      .def_property_readonly("tissue", &tissuePlanes, "(frames, across, along) uint8.")
      .def_property_readonly("cells_mm", &cellPlaces, "(across, along, 2) float32.")
      .def("boundary", &boundaryOf, py::arg("frame"), "Points and structures.");
  py::class_<fit::HeartPrior>(module, "HeartPrior", "The distribution of hearts of a fit.")
      .def(py::init<>())
      .def("log_density", &logDensity, py::arg("dials"), "Of given dials.")
      .def("draw", &drawFrom, py::arg("seed"), py::arg("number"), "Dials of a random heart.")
      .def_property_readonly("mean", &meanOf, "By dial.")
      .def_property_readonly("sd", &sdOf, "By dial.");
}

}  // namespace echocine::python
