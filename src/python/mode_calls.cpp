// M-mode and tissue Doppler as calls.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "doppler/doppler_files.h"
#include "mmode/mmode_files.h"
#include "motion/surfaces/probe_placement.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/job.h"
#include "python/native_scene.h"
#include "scene/names.h"

namespace echocine::python {

namespace {

using Folder = std::optional<std::filesystem::path>;

template <typename Enum>
std::optional<Enum> wordOf(const char* name, const std::optional<std::string>& word) {
  if (!word) return {};
  const std::optional<Enum> value = valueOf<Enum>(*word);
  if (value) return value;
  std::string accepted;
  for (const auto& one : NamesOf<Enum>::kAll)
    accepted += fmt::format("{}{}", accepted.empty() ? "" : ", ", one.name);
  throw SceneError(fmt::format("{}: \"{}\", accepted: {}", name, *word, accepted));
}

// Column-major values as (row, column).
py::array_t<float> transposed(const std::vector<float>& values, int columns, int rows) {
  py::array_t<float> out({py::ssize_t{rows}, py::ssize_t{columns}});
  auto at = out.mutable_unchecked<2>();
  for (py::ssize_t t = 0; t < columns; ++t)
    for (py::ssize_t k = 0; k < rows; ++k)
      at(k, t) = values[static_cast<std::size_t>(t * rows + k)];
  return out;
}

py::tuple timesOf(const std::vector<FrameTime>& times) {
  std::vector<double> seconds, phases;
  for (const FrameTime& time : times) {
    seconds.push_back(time.time_s);
    phases.push_back(time.phase);
  }
  return py::make_tuple(copyOf(seconds), copyOf(phases));
}

py::dict dictOf(const MMode& mode, const Scene& scene) {
  py::dict out;
  out["line"] = mode.line;
  out["times"] = timesOf(mode.times);
  out["intensities"] = transposed(mode.intensities.values, mode.columns, mode.samples);
  out["greys"] = transposed(mode.greys.values, mode.columns, mode.samples);
  py::list borders;
  for (const BorderCrossing& c : mode.borders)
    borders.append(py::make_tuple(c.column, scene.structures[index(c.surface)].name,
                                  millimetresFromMetres(c.depth_m)));
  out["borders"] = borders;
  if (mode.ring)
    out["ring"] = py::make_tuple(copyOf(mode.ring->exact_m), copyOf(mode.ring->traced_m),
                                 mode.ring->exact_mm, mode.ring->traced_mm, mode.ring->in_space_mm);
  return out;
}

py::dict mmode(const NativeScene& native, const Folder& folder, std::optional<double> angle_deg,
               std::optional<double> offset_mm, const std::optional<std::string>& through,
               double rate_hz, int rows, int threads, const py::object& progress) {
  MModeOptions options;
  options.request.place = placeGiven(native.scene.probe, angle_deg, offset_mm);
  options.request.through = wordOf<MModeTarget>("through", through);
  options.request.rate_hz = rate_hz;
  options.rows = rows;
  options.threads = threads;
  MMode mode;
  runJob(progress, [&](const Monitor& monitor) {
    if (folder) {
      options.folder = *folder;
      mode = writeMMode(native.scene, options, monitor);
      return;
    }
    withThreads(threads, [&] {
      const Simulator simulator(mmodeScene(placed(native.scene), options.request));
      passWarnings(simulator, monitor);
      mode = makeMMode(simulator, options.request, monitor);
    });
  });
  return dictOf(mode, native.scene);
}

// Frames that have been measured, one after the other.
struct Measured {
  std::vector<float> velocity, variance, power, exact;
  std::vector<FrameTime> times;

  void take(const DopplerFrame& frame) {
    const auto append = [](const std::vector<float>& from, std::vector<float>& to) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(frame.measured.velocity_m_s, velocity);
    append(frame.measured.variance_m2_s2, variance);
    append(frame.measured.power, power);
    append(frame.exact_m_s, exact);
    times.push_back(frame.time);
  }
};

py::dict dictOf(const Measured& frames, const DopplerSummary& summary, const Probe& probe) {
  py::dict out;
  out["nyquist_m_s"] = summary.nyquist_m_s;
  out["against_truth"] = py::make_tuple(summary.bias_m_s, summary.rms_m_s, summary.aliased_share);
  out["times"] = timesOf(frames.times);
  const auto planes = [&](const std::vector<float>& values) {
    auto* kept = new std::vector<float>(values);
    const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<float>*>(p); });
    return planesView(kept->data(), static_cast<py::ssize_t>(frames.times.size()), probe.lines,
                      probe.samples, owner);
  };
  out["velocity"] = planes(frames.velocity);
  out["variance"] = planes(frames.variance);
  out["power"] = planes(frames.power);
  out["exact"] = planes(frames.exact);
  if (const auto& s = summary.spectrum)
    out["spectrum"] =
        py::make_tuple(timesOf(s->times), transposed(s->power, s->columns, s->bins),
                       copyOf(s->mean_m_s), copyOf(s->exact_m_s), s->mean_peak, s->exact_peak);
  return out;
}

py::dict doppler(const NativeScene& native, const Folder& folder, double prf_hz, int pulses,
                 double gate_mm, const std::string& wall, std::optional<double> depth_mm,
                 std::optional<double> angle_deg, std::optional<double> offset_mm,
                 const std::optional<std::string>& through, std::optional<double> volume_mm,
                 int threads, const py::object& progress) {
  Measured frames;
  DopplerOptions options;
  options.request = {pulses, prf_hz, metresFromMillimetres(gate_mm),
                     *wordOf<WallFilterKind>("wall_filter", wall)};
  if (depth_mm || through) {
    SpectrumRequest& spectrum = options.spectrum.emplace();
    if (volume_mm) spectrum.volume_m = metresFromMillimetres(*volume_mm);
    if (depth_mm) spectrum.at.depth_m = metresFromMillimetres(*depth_mm);
    spectrum.at.place = placeGiven(native.scene.probe, angle_deg, offset_mm);
    spectrum.at.through = wordOf<MModeTarget>("through", through);
  }
  options.folder = folder.value_or("");
  options.threads = threads;
  options.take = [&](const DopplerFrame& frame) { frames.take(frame); };
  DopplerSummary summary;
  runJob(progress,
         [&](const Monitor& monitor) { summary = writeDoppler(native.scene, options, monitor); });
  return dictOf(frames, summary, native.scene.probe);
}

}  // namespace

void bindModes(py::module_& module) {
  module.def("mmode", &mmode, py::arg("scene"), py::arg("folder").none(true),
             py::arg("angle_deg").none(true), py::arg("offset_mm").none(true),
             py::arg("through").none(true), py::arg("rate_hz"), py::arg("rows"), py::arg("threads"),
             py::arg("progress").none(true), "One scan line over time.");
  module.def("doppler", &doppler, py::arg("scene"), py::arg("folder").none(true), py::arg("prf_hz"),
             py::arg("pulses"), py::arg("gate_mm"), py::arg("wall_filter"),
             py::arg("depth_mm").none(true), py::arg("angle_deg").none(true),
             py::arg("offset_mm").none(true), py::arg("through").none(true),
             py::arg("volume_mm").none(true), py::arg("threads"), py::arg("progress").none(true),
             "Velocities from pulses.");
}

}  // namespace echocine::python
