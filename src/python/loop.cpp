#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "loop/loop.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/surfaces/probe_placement.h"
#include "output/function_json.h"
#include "plan/loop_plan.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/frame.h"
#include "python/job.h"
#include "python/native_scene.h"
#include "study/tolerance.h"

namespace echocine::python {

namespace {

using LoopPointer = std::shared_ptr<Loop>;

LoopPointer renderInMemory(const NativeScene& scene,
                           const std::optional<std::pair<int, int>>& frames, int threads,
                           const py::object& progress) {
  const int count = CardiacClock(scene.scene).frameCount();
  const std::pair range = frames.value_or(std::pair(0, count));
  if (range.first < 0 || range.first >= range.second || range.second > count)
    throw SceneError(
        fmt::format("frames: ({}, {}) is not in the loop, accepted: (A, B) with 0 <= A < B <= {}",
                    range.first, range.second, count));
  auto loop = std::make_shared<Loop>();
  runJob(progress, [&](const Monitor& monitor) {
    const Scene wanted = atOwnTolerance(placed(scene.scene), threads, monitor).scene;
    std::optional<Simulator> simulator;
    withThreads(threads, [&] { simulator.emplace(wanted); });
    passWarnings(*simulator, monitor);
    *loop = renderInMemory(*simulator, range, monitor, threads);
  });
  return loop;
}

// Views by name; a name that is absent was not asked for.
py::dict arrays(const py::object& self) {
  const Loop& loop = self.cast<const Loop&>();
  const auto t = static_cast<py::ssize_t>(loop.frames);
  py::dict named;
  const auto add = [&](const char* name, const auto& values,
                       const std::vector<py::ssize_t>& shape) {
    if (!values.empty()) named[name] = viewOf(values.data(), shape, self);
  };
  add("images", loop.images, {t, loop.height, loop.width});
  add("labels", loop.labels, {t, loop.height, loop.width});
  if (!loop.greys.empty())
    named["greys"] = planesView(loop.greys.data(), t, loop.lines, loop.samples, self);
  const auto points = static_cast<py::ssize_t>(loop.track_layer.size());
  add("tracks", loop.tracks_mm, {t, points, 3});
  add("track_layer", loop.track_layer, {points});
  add("track_segment", loop.track_segment, {points});
  constexpr auto kItem = static_cast<py::ssize_t>(sizeof(float));
  const py::ssize_t plane = static_cast<py::ssize_t>(loop.lines) * loop.samples * kItem;
  for (const auto& [name, values] : {std::pair("displacement", &loop.displacement_mm),
                                     std::pair("velocity", &loop.velocity_mm_s)})
    if (!values->empty())
      named[name] =
          py::array(py::dtype::of<float>(),
                    {t, py::ssize_t{3}, py::ssize_t{loop.samples}, py::ssize_t{loop.lines}},
                    {3 * plane, plane, kItem, loop.samples * kItem}, values->data(), self);
  if (!loop.velocity_beam_m_s.empty())
    named["velocity_beam"] =
        planesView(loop.velocity_beam_m_s.data(), t, loop.lines, loop.samples, self);
  return named;
}

// Components of motion that the scene's channels request: lateral, axial, elevation.
void addMotion(const Loop& loop, const py::object& self, py::dict& named) {
  const py::ssize_t samples = loop.samples, lines = loop.lines, plane = samples * lines;
  constexpr auto kItem = static_cast<py::ssize_t>(sizeof(float));
  for (const auto& [first, values] :
       {std::pair(Channel::displacement_lateral, &loop.displacement_mm),
        std::pair(Channel::velocity_lateral, &loop.velocity_mm_s)})
    for (int side = 0; side < 3; ++side) {
      const auto channel = static_cast<Channel>(static_cast<int>(first) + side);
      if (!values->empty() && wants(loop.scene, channel))
        named[channelName(channel)] = py::array(
            py::dtype::of<float>(), {py::ssize_t{loop.frames}, samples, lines},
            {3 * plane * kItem, kItem, samples * kItem}, values->data() + side * plane, self);
    }
  if (!loop.velocity_beam_m_s.empty() && wants(loop.scene, Channel::velocity_beam))
    named[channelName(Channel::velocity_beam)] =
        planesView(loop.velocity_beam_m_s.data(), loop.frames, lines, samples, self);
}

py::dict channels(const py::object& self) {
  const Loop& loop = self.cast<const Loop&>();
  py::dict named;
  addMotion(loop, self, named);
  for (const auto& [channel, values] : loop.planes)
    named[channelName(channel)] =
        planesView(values.data(), loop.frames, loop.lines, loop.samples, self);
  for (const auto& [channel, values] : loop.ids)
    named[channelName(channel)] =
        planesView(values.data(), loop.frames, loop.lines, loop.samples, self);
  if (!loop.greys.empty() && wants(loop.scene, Channel::display))
    named[channelName(Channel::display)] =
        planesView(loop.greys.data(), loop.frames, loop.lines, loop.samples, self);
  return named;
}

template <typename Of>
py::array perFrame(const Loop& loop, const Of& of) {
  std::vector<double> values;
  for (const FrameTime& time : loop.times) values.push_back(of(time));
  return copyOf(values);
}

py::dict volumes(const Loop& loop) {
  py::dict named;
  for (const auto& [name, ml] : loop.volumes_ml) named[py::str(name)] = copyOf(ml);
  return named;
}

py::dict curves(const Loop& loop) {
  py::dict named;
  if (loop.function.empty()) return named;
  for (const auto& [name, values] : functionCurves(loop.function))
    named[py::str(name)] = copyOf(values);
  return named;
}

// (T, 17, 3): longitudinal, radial, circumferential.
py::object strain(const Loop& loop) {
  if (loop.function.empty()) return py::none();
  const auto t = static_cast<py::ssize_t>(loop.function.size());
  py::array_t<double> values({t, static_cast<py::ssize_t>(kAhaSegments), py::ssize_t{3}});
  auto at = values.mutable_unchecked<3>();
  for (py::ssize_t f = 0; f < t; ++f)
    for (py::ssize_t s = 0; s < at.shape(1); ++s) {
      const SegmentStrain& one =
          loop.function[static_cast<std::size_t>(f)].segments[static_cast<std::size_t>(s)];
      at(f, s, 0) = one.longitudinal;
      at(f, s, 1) = one.radial;
      at(f, s, 2) = one.circumferential;
    }
  return values;
}

py::list contours(const Loop& loop) {
  py::list list;
  for (const auto& frame : loop.contours) list.append(contoursOf(frame, loop.scene));
  return list;
}

}  // namespace

void bindLoop(py::module_& module) {
  py::class_<Loop, LoopPointer>(module, "LoopArrays", "A loop in memory.")
      .def_property_readonly("arrays", &arrays, "Views by name.")
      .def_property_readonly("channels", &channels, "Views (T, depth, line) by channel.")
      .def_property_readonly(
          "times_s",
          [](const Loop& l) { return perFrame(l, [](const FrameTime& t) { return t.time_s; }); },
          "(T,) float64, s.")
      .def_property_readonly(
          "phases",
          [](const Loop& l) { return perFrame(l, [](const FrameTime& t) { return t.phase; }); },
          "(T,) float64, of the beat.")
      .def_property_readonly("volumes", &volumes, "Structure -> (T,) float64, mL.")
      .def_property_readonly("curves", &curves, "Name with unit -> (T,) float64.")
      .def_property_readonly("strain", &strain, "(T, 17, 3) float64, or None.")
      .def_property_readonly("contours", &contours, "Per frame a list of dicts.")
      .def_property_readonly(
          "reference_intensity", [](const Loop& l) { return l.reference_intensity; },
          "White of the log compression, relative to the transmitted.");
  module.def("render_in_memory", &renderInMemory, py::arg("scene"), py::arg("frames").none(true),
             py::arg("threads"), py::arg("progress").none(true), "A loop as arrays.");
}

}  // namespace echocine::python
