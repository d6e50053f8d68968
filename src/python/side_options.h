#pragma once
// Arguments that comparisons with a real loop share.

#include <pybind11/pybind11.h>

#include "echo/read_loop.h"

namespace echocine::python {

// The options of a loop, as the command has them. Throws ValueError naming `argument` for an
// unknown key.
echo::SideOptions sideOf(const pybind11::dict& given, const char* argument);

// Throws ValueError unless it is an accepted limit of the tilt.
double tiltOf(double tilt_deg);

}  // namespace echocine::python
