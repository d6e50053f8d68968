// Frames into memory that is there already.

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "core/check.h"
#include "plan/effect_plan.h"
#include "python/arrays.h"
#include "python/frame.h"

namespace echocine::python {

namespace {

// Memory that arrays may be views of stays where it is.
template <typename T>
void copyPlane(const std::vector<T>& from, std::vector<T>& to) {
  CHECK_EQ(from.size(), to.size());
  std::copy(from.begin(), from.end(), to.begin());
}

void copyTruth(const FrameTruth& from, FrameTruth& to) {
  copyPlane(from.labels, to.labels);
  copyPlane(from.sample_ids, to.sample_ids);
  for (std::size_t i = 0; i < 3; ++i) {
    copyPlane(from.motion.displacement_mm[i], to.motion.displacement_mm[i]);
    copyPlane(from.motion.velocity_mm_s[i], to.motion.velocity_mm_s[i]);
  }
  copyPlane(from.motion.beam_m_s, to.motion.beam_m_s);
  copyPlane(from.tracks_m, to.tracks_m);
}

template <typename T>
void copyTransposed(const std::vector<T>& line_major, const py::array& to) {
  auto* const base = static_cast<char*>(const_cast<void*>(to.data()));
  const py::ssize_t samples = to.shape(0), lines = to.shape(1);
  for (py::ssize_t i = 0; i < lines; ++i)
    for (py::ssize_t k = 0; k < samples; ++k)
      std::memcpy(base + k * to.strides(0) + i * to.strides(1),
                  &line_major[static_cast<std::size_t>(i * samples + k)], sizeof(T));
}

void copyPicture(const std::vector<std::uint8_t>& pixels, const py::array& to) {
  auto* const base = static_cast<char*>(const_cast<void*>(to.data()));
  for (py::ssize_t y = 0; y < to.shape(0); ++y)
    for (py::ssize_t x = 0; x < to.shape(1); ++x)
      std::memcpy(base + y * to.strides(0) + x * to.strides(1),
                  &pixels[static_cast<std::size_t>(y * to.shape(1) + x)], 1);
}

// Interleaved arrays of one buffer are apart.
bool shareMemory(const py::array& a, const py::array& b) {
  return py::module_::import("numpy").attr("shares_memory")(a, b).cast<bool>();
}

bool isMade(const std::string& name, const Scene& scene) {
  if (name == "intensities") return wants(scene, Channel::y);
  if (name == "labels") return scene.truth.labels;
  return wantsPicture(scene) && (name == "greys" || scene.output.pictures());
}

}  // namespace

void copyInPlace(const Frame& from, Frame& to) {
  copyPlane(from.intensities.values, to.intensities.values);
  copyPlane(from.greys.values, to.greys.values);
  copyPlane(from.image.pixels, to.image.pixels);
  for (const auto& [channel, values] : from.channels) copyPlane(values, to.channels[channel]);
  copyPlane(from.medium, to.medium);
  if (from.truth) copyTruth(*from.truth, *to.truth);
}

void moveRest(Frame& from, Frame& to) {
  to.time = from.time;
  to.volumes_ml = std::move(from.volumes_ml);
  if (!from.truth) return;
  to.truth->contours = std::move(from.truth->contours);
  to.truth->function = std::move(from.truth->function);
}

std::vector<OutArray> checkedOutArrays(const py::dict& given, const Scene& scene) {
  const std::vector<py::ssize_t> polar{scene.probe.samples, scene.probe.lines},
      picture{scene.output.height, scene.output.width};
  std::vector<OutArray> arrays;
  for (const auto& [key, value] : given) {
    const auto name = py::str(key).cast<std::string>();
    const bool is_polar = name == "intensities" || name == "greys";
    if (!is_polar && name != "image" && name != "labels")
      throw py::value_error(fmt::format(
          "out: \"{}\" is not known, accepted: \"intensities\", \"greys\", \"image\", \"labels\"",
          name));
    if (!isMade(name, scene))
      throw py::value_error(fmt::format("out[\"{}\"]: the scene does not request it", name));
    const auto array =
        checkedOut(fmt::format("out[\"{}\"]", name), py::reinterpret_borrow<py::object>(value),
                   is_polar ? py::dtype::of<float>() : py::dtype::of<std::uint8_t>(),
                   is_polar ? polar : picture);
    for (const OutArray& other : arrays)
      if (shareMemory(other.array, array))
        throw py::value_error(
            fmt::format("out[\"{}\"]: shares memory with out[\"{}\"], accepted: arrays apart", name,
                        other.name));
    arrays.push_back({name, array});
  }
  return arrays;
}

void copyInto(const Frame& frame, const std::vector<OutArray>& out) {
  for (const OutArray& one : out) {
    if (one.name == "intensities")
      copyTransposed(frame.channels.at(Channel::y), one.array);
    else if (one.name == "greys")
      copyTransposed(frame.greys.values, one.array);
    else
      copyPicture(one.name == "image" ? frame.image.pixels : frame.truth->labels, one.array);
  }
}

py::list contoursOf(const std::vector<Contour>& contours, const Scene& scene) {
  py::list list;
  for (const Contour& contour : contours) {
    py::array_t<double> points({static_cast<py::ssize_t>(contour.points_m.size()), py::ssize_t{2}});
    auto at = points.mutable_unchecked<2>();
    for (py::ssize_t i = 0; i < at.shape(0); ++i) {
      at(i, 0) = 1e3 * contour.points_m[static_cast<std::size_t>(i)].x;
      at(i, 1) = 1e3 * contour.points_m[static_cast<std::size_t>(i)].z;
    }
    py::dict entry;
    entry["structure"] = scene.structures[index(contour.surface)].name;
    entry["closed"] = contour.closed;
    entry["points_mm"] = points;
    py::array_t<bool> visible(static_cast<py::ssize_t>(contour.visible.size()));
    std::copy(contour.visible.begin(), contour.visible.end(), visible.mutable_data());
    entry["visible"] = contour.visible.empty() ? py::object(py::none()) : py::object(visible);
    list.append(entry);
  }
  return list;
}

}  // namespace echocine::python
