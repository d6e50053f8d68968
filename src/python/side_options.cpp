#include "python/side_options.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "fit/plane_tilt.h"

namespace echocine::python {

namespace py = pybind11;

echo::SideOptions sideOf(const py::dict& given, const char* argument) {
  echo::SideOptions side;
  for (const auto& [key, value] : given) {
    const auto name = py::str(key).cast<std::string>();
    if (name == "fps")
      side.fps = value.cast<double>();
    else if (name == "mm_per_pixel")
      side.mm_per_pixel = value.cast<double>();
    else if (name == "pixel_aspect")
      side.pixel_aspect = value.cast<double>();
    else if (name == "heart_rate_bpm")
      side.heart_rate_bpm = value.cast<double>();
    else if (name == "sector")
      side.sector = value.cast<std::string>();
    else if (name == "ed_frame")
      side.ed_frame = value.cast<double>();
    else if (name == "es_frame")
      side.es_frame = value.cast<double>();
    else if (name == "r_waves_s")
      side.r_waves_s = value.cast<std::vector<double>>();
    else if (name == "label")
      side.label = value.cast<std::string>();
    else if (name == "read_ecg")
      side.read_ecg = value.cast<bool>();
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
