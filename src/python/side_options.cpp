#include "python/side_options.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "fit/plane_tilt.h"

namespace echocine::python {

namespace py = pybind11;

echo::SideOptions sideOf(const py::dict& given, const char* argument) {
  echo::SideOptions side;
  for (const auto& [key, given_value] : given) {
    const auto name = py::str(key).cast<std::string>();
    const py::handle value = given_value;
    const bool is_bool = py::isinstance<py::bool_>(value);
    const auto refuse = [&](const char* accepted) {
      throw py::value_error(fmt::format("{}: {}: is {}, accepted: {}", argument, name,
                                        py::repr(value).cast<std::string>(), accepted));
    };
    const auto as = [&]<typename T>(T, const char* accepted) {
      try {
        return value.cast<T>();
      } catch (const py::cast_error&) {
        refuse(accepted);
        throw;
      }
    };
    const auto number = [&] {
      if (is_bool) refuse("a number");
      return as(double{}, "a number");
    };
    if (name == "fps")
      side.fps = number();
    else if (name == "mm_per_pixel")
      side.mm_per_pixel = number();
    else if (name == "pixel_aspect")
      side.pixel_aspect = number();
    else if (name == "heart_rate_bpm")
      side.heart_rate_bpm = number();
    else if (name == "sector")
      side.sector = as(std::string{}, "text");
    else if (name == "ed_frame")
      side.ed_frame = number();
    else if (name == "es_frame")
      side.es_frame = number();
    else if (name == "r_waves_s")
      side.r_waves_s = as(std::vector<double>{}, "a list of numbers");
    else if (name == "label")
      side.label = as(std::string{}, "text");
    else if (name == "read_ecg" && value.is_none())
      refuse("True or False");
    else if (name == "read_ecg")
      side.read_ecg = as(bool{}, "True or False");
    else
      throw py::value_error(
          fmt::format("{}: \"{}\" is not known, accepted: fps, mm_per_pixel, pixel_aspect, "
                      "heart_rate_bpm, sector, ed_frame, es_frame, r_waves_s, read_ecg, label",
                      argument, name));
  }
  return side;
}

double tiltOf(double tilt_deg) {
  if (!(tilt_deg >= 0 && tilt_deg <= fit::kMostTilt_deg))
    throw py::value_error(
        fmt::format("tilt_deg: is {:g}, accepted: 0 to {:g}", tilt_deg, fit::kMostTilt_deg));
  return tilt_deg;
}

}  // namespace echocine::python
