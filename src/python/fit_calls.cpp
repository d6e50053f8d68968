// The discrepancy of models in a real loop, for optimisers.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/units.h"
#include "fit/dial_checks.h"
#include "fit/fit_residuals.h"
#include "fit/model_discrepancy.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/job.h"
#include "python/side_options.h"

namespace echocine::python {

namespace {

using Path = std::filesystem::path;

// Columns of a pose.
constexpr const char* kPoseColumns = "shift_x_mm, shift_z_mm, turn_deg, scale, lag, systole";
constexpr py::ssize_t kPoseNumbers = 6;

fit::FitPose poseOf(const double* row, const char* argument) {
  if (!(std::abs(row[4]) <= fit::kMostLag && row[4] == std::round(row[4])))
    throw py::value_error(fmt::format("{}: lag is {:g}, accepted: a whole number, {} to {}",
                                      argument, row[4], -fit::kMostLag, fit::kMostLag));
  const fit::FitPose pose{metresFromMillimetres(row[0]), metresFromMillimetres(row[1]),
                          radiansFromDegrees(row[2]),    row[3],
                          static_cast<int>(row[4]),      row[5]};
  fit::checkPose(pose);
  return pose;
}

std::vector<fit::FitPose> posesOf(const Doubles& given, const char* argument) {
  const py::ssize_t n = given.ndim();
  if ((n != 1 && n != 2) || given.shape(n - 1) != kPoseNumbers)
    throw py::value_error(fmt::format("{}: is {}, accepted: ({},) or (poses, {}), float64: {}",
                                      argument, shown(given), kPoseNumbers, kPoseNumbers,
                                      kPoseColumns));
  std::vector<fit::FitPose> poses;
  for (py::ssize_t i = 0; i < given.size(); i += kPoseNumbers)
    poses.push_back(poseOf(given.data() + i, argument));
  return poses;
}

void putPose(const fit::FitPose& pose, double* row) {
  row[0] = millimetresFromMetres(pose.shift_x_m);
  row[1] = millimetresFromMetres(pose.shift_z_m);
  row[2] = degreesFromRadians(pose.turn_rad);
  row[3] = pose.scale;
  row[4] = pose.lag;
  row[5] = pose.systole;
}

void putTerms(const fit::FitTerms& terms, double* row) {
  row[0] = terms.region;
  row[1] = terms.boundary;
  row[2] = terms.motion;
  row[3] = terms.overlap;
}

py::dict dictOf(const fit::PoseFound& found) {
  py::array_t<double> pose(kPoseNumbers), terms(4);
  putPose(found.pose, pose.mutable_data());
  putTerms(found.terms, terms.mutable_data());
  const auto count = static_cast<py::ssize_t>(found.rivals.size());
  py::array_t<double> rivals({count, kPoseNumbers + 1});
  for (py::ssize_t i = 0; i < count; ++i) {
    const auto& [rival, value] = found.rivals[static_cast<std::size_t>(i)];
    double* row = rivals.mutable_data() + i * (kPoseNumbers + 1);
    putPose(rival, row);
    row[kPoseNumbers] = value;
  }
  py::dict out;
  out["discrepancy"] = found.discrepancy;
  out["pose"] = pose;
  out["terms"] = terms;
  out["rivals"] = rivals;
  out["confidence"] = found.confidence;
  out["at_limit"] = found.at_limit;
  return out;
}

using Measure = fit::ModelDiscrepancy;

std::shared_ptr<Measure> makeMeasure(const Path& real, const fit::ModelLoop& first,
                                     const py::dict& side, const std::vector<double>& weights,
                                     int threads, const py::object& progress) {
  const echo::SideOptions options = sideOf(side, "side");
  if (weights.size() != 3)
    throw py::value_error(fmt::format(
        "weights: holds {} numbers, accepted: 3, of region, boundary and motion", weights.size()));
  fit::FitSettings settings;
  settings.weights = {weights[0], weights[1], weights[2]};
  std::shared_ptr<Measure> made;
  runJob(progress, [&](const Monitor&) {
    withThreads(threads, [&] {
      made =
          std::make_shared<Measure>(echo::readLoop(real, options, true), options, first, settings);
    });
  });
  return made;
}

// (P, 5): D, region, boundary, motion, overlap.
py::array termsAt(const Measure& measure, const fit::ModelLoop& model, const Doubles& given) {
  const std::vector<fit::FitPose> poses = posesOf(given, "poses");
  std::vector<fit::FitTerms> terms;
  runHere([&] { inThisThread([&] { terms = measure.terms(model, poses); }); });
  constexpr py::ssize_t kColumns = 5;
  py::array_t<double> out({static_cast<py::ssize_t>(terms.size()), kColumns});
  double* row = out.mutable_data();
  for (const fit::FitTerms& t : terms) {
    row[0] = fit::fitDiscrepancy(t, measure.settings().weights);
    putTerms(t, row + 1);
    row += kColumns;
  }
  return out;
}

// Eq. 18.
py::array residualsAt(const Measure& measure, const fit::ModelLoop& model, const Doubles& given) {
  if (given.ndim() != 1)
    throw py::value_error(fmt::format("pose: is {}, accepted: ({},)", shown(given), kPoseNumbers));
  const fit::FitPose pose = posesOf(given, "pose").front();
  std::vector<double> values;
  runHere([&] { inThisThread([&] { values = fit::residualsOf(measure, model, pose); }); });
  py::array_t<double> out(static_cast<py::ssize_t>(values.size()));
  std::copy(values.begin(), values.end(), out.mutable_data());
  return out;
}

py::dict search(const Measure& measure, const fit::ModelLoop& model,
                const std::optional<Doubles>& starts, bool global, int threads) {
  const std::vector<fit::FitPose> from =
      starts ? posesOf(*starts, "starts") : std::vector<fit::FitPose>{};
  fit::PoseFound found;
  runJob(py::none(), [&](const Monitor&) {
    withThreads(threads, [&] {
      found = !global        ? measure.refine(model, from)
              : from.empty() ? measure.search(model)
                             : measure.searchAlsoFrom(model, from);
    });
  });
  return dictOf(found);
}

py::dict beatOf(const Measure& measure) {
  const fit::BeatFound& beat = measure.beat();
  py::dict out;
  out["end_diastole"] = beat.span.end_diastole;
  out["frames"] = beat.span.frames;
  out["systole"] = beat.span.systole;
  out["length_source"] = beat.length_source;
  out["start_source"] = beat.start_source;
  out["confidence"] = beat.confidence;
  out["systole_source"] = beat.systole_source;
  out["systole_confidence"] = beat.systole_confidence;
  return out;
}

}  // namespace

void bindFit(py::module_& module) {
  py::class_<Measure, std::shared_ptr<Measure>>(module, "ModelDiscrepancy",
                                                "Discrepancy between a real loop and models.")
      .def(py::init(&makeMeasure), py::arg("real"), py::arg("first"), py::arg("side"),
           py::arg("weights"), py::arg("threads"), py::arg("progress").none(true))
      .def("terms", &termsAt, py::arg("model"), py::arg("poses"), "D and its terms.")
      .def("residuals", &residualsAt, py::arg("model"), py::arg("pose"), "D as residuals.")
      .def("search", &search, py::arg("model"), py::arg("starts").none(true), py::arg("everywhere"),
           py::arg("threads"), "The pose of lowest D.")
      .def_property_readonly("beat", &beatOf, "Start and length of the real beat.");
}

}  // namespace echocine::python
