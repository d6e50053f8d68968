#include "python/frame.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "python/arrays.h"

namespace echocine::python {

namespace {

// The Python object of a frame, which its arrays keep alive.
struct Held {
  py::object self;
  NativeFrame& native;
  explicit Held(py::object object) : self(std::move(object)), native(self.cast<NativeFrame&>()) {}

  template <typename T>
  py::array plane(const std::vector<T>& values) const {
    return planesView(values.data(), -1, native.frame.lines, native.frame.samples, self);
  }
};

[[noreturn]] void absent(const char* what, const char* remedy) {
  throw py::value_error(
      fmt::format("{}: the scene does not request it, accepted: {}", what, remedy));
}

py::array intensities(const py::object& self) {
  const Held held(self);
  const auto found = held.native.frame.channels.find(Channel::y);
  if (found == held.native.frame.channels.end())
    absent("intensities", "output.channels with \"Y\" and output.exr = true");
  return held.plane(found->second);
}

py::array compensated(const py::object& self) {
  const Held held(self);
  if (held.native.frame.intensities.empty()) absent("compensated", "a scene with a picture");
  return held.plane(held.native.frame.intensities.values);
}

py::array greys(const py::object& self) {
  const Held held(self);
  if (held.native.frame.greys.empty())
    absent("greys", "a scene with a picture, output.cine = true");
  return held.plane(held.native.frame.greys.values);
}

py::array image(const py::object& self) {
  const Held held(self);
  const GreyImage& picture = held.native.frame.image;
  if (picture.pixels.empty()) absent("image", "output.cine = true or output.png = true");
  return viewOf(picture.pixels.data(), {picture.height, picture.width}, self);
}

py::array labels(const py::object& self) {
  const Held held(self);
  const Frame& frame = held.native.frame;
  if (!frame.truth || frame.truth->labels.empty()) absent("labels", "truth.write with \"labels\"");
  return viewOf(frame.truth->labels.data(), {held.native.height, held.native.width}, self);
}

py::array tracks(const py::object& self) {
  const Held held(self);
  const Frame& frame = held.native.frame;
  if (!frame.truth || frame.truth->tracks_m.empty())
    absent("tracks", "truth.write with \"tracks\"");
  py::array_t<float> tracks_mm(
      {static_cast<py::ssize_t>(frame.truth->tracks_m.size()), py::ssize_t{3}});
  float* at = tracks_mm.mutable_data();
  for (const Vec3f p : frame.truth->tracks_m)
    for (const float metres : {p.x, p.y, p.z}) *at++ = 1e3f * metres;  // as LoopArrays has them
  return tracks_mm;
}

void addTruthPlanes(const Held& held, py::dict& planes) {
  const FrameTruth& truth = *held.native.frame.truth;
  for (const Channel channel : kTruthChannels) {
    if (channel == Channel::structure) {
      if (!truth.sample_ids.empty()) planes[channelName(channel)] = held.plane(truth.sample_ids);
    } else if (const std::span<const float> values = truth.values(channel); !values.empty()) {
      planes[channelName(channel)] = planesView(values.data(), -1, held.native.frame.lines,
                                                held.native.frame.samples, held.self);
    }
  }
}

py::dict channels(const py::object& self) {
  const Held held(self);
  py::dict planes;
  for (const auto& [channel, values] : held.native.frame.channels)
    planes[channelName(channel)] = held.plane(values);
  if (!held.native.frame.medium.empty())
    planes[channelName(Channel::medium)] = held.plane(held.native.frame.medium);
  if (held.native.frame.truth) addTruthPlanes(held, planes);
  return planes;
}

py::dict volumes(const NativeFrame& native) {
  py::dict named;
  for (const auto& [name, ml] : native.frame.volumes_ml) named[py::str(name)] = ml;
  return named;
}

}  // namespace

void bindFrame(py::module_& module) {
  py::class_<NativeFrame, std::shared_ptr<NativeFrame>>(
      module, "Frame", "One frame of a scene. Arrays are views of its memory and keep it alive.")
      .def_property_readonly(
          "time_s", [](const NativeFrame& n) { return n.frame.time.time_s; },
          "Instant from the loop's start, s.")
      .def_property_readonly(
          "phase", [](const NativeFrame& n) { return n.frame.time.phase; },
          "Phase of the beat, 0 <= phase < 1; 0 at end-diastole.")
      .def_property_readonly(
          "beat", [](const NativeFrame& n) { return n.frame.time.beat; },
          "Beat of the loop, from 0.")
      .def_property_readonly("volumes", &volumes, "Closed structures' volumes by name, mL.")
      .def_property_readonly(
          "intensities", &intensities,
          "(depth, line) float32: received, relative to the transmitted; channel \"Y\".")
      .def_property_readonly(
          "compensated", &compensated,
          "(depth, line) float32: after time gain and the average over the beam.")
      .def_property_readonly("greys", &greys,
                             "(depth, line) float32: log-compressed, 0 black to 1 white.")
      .def_property_readonly("image", &image,
                             "(H, W) uint8 pixels: the picture, without ECG and depth ticks.")
      .def_property_readonly("channels", &channels,
                             "Each channel of output.channels by name, except display.Y (greys); "
                             "(depth, line) float32 or uint32.")
      .def_property_readonly("labels", &labels, "(H, W) uint8: structures at the picture's pixels.")
      .def_property_readonly(
          "tracks", &tracks,
          "(N, 3) float32: material points, lateral, elevation and depth, mm. A copy.");
}

}  // namespace echocine::python
