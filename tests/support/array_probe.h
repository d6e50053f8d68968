#pragma once
// A phased array of 64 elements, 0.3 mm apart, with the focus of the array simulator's runs.

#include "core/units.h"
#include "scene/probe.h"

namespace echocine::support {

inline Probe arrayProbe() {
  Probe probe;
  probe.first_angle_rad = radiansFromDegrees(-45);
  probe.last_angle_rad = radiansFromDegrees(45);
  probe.min_depth_m = 0.01;
  probe.max_depth_m = 0.15;
  probe.frequency_hz = 2.72e6;
  probe.aperture_m = 64 * 0.3e-3;
  probe.focus_m = 0.08;
  probe.lines = 361;
  probe.samples = 560;
  return probe;
}

}  // namespace echocine::support
