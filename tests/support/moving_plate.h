#pragma once
// A plate that moves along the probe's axis.

#include <cmath>
#include <numbers>
#include <string>

#include "support/meshes.h"
#include "support/temp_folder.h"

namespace echocine::support {

// plate_00.obj, plate_01.obj ...: `keyframes` over a beat. The near face of the plate lies at
// 60 mm - stroke (1 - cos(2 pi phase)) / 2.
inline void writePlates(const TempFolder& folder, int keyframes, double stroke_mm,
                        double thickness_cm) {
  for (int i = 0; i < keyframes; ++i) {
    const double up_cm = 0.05 * stroke_mm * (1 - std::cos(2 * std::numbers::pi * i / keyframes));
    const double z_cm = 6 - up_cm;
    writeObj(box({-3, -3, z_cm}, {3, 3, z_cm + thickness_cm}),
             folder / ("plate_" + std::string(i < 10 ? "0" : "") + std::to_string(i) + ".obj"));
  }
}

}  // namespace echocine::support
