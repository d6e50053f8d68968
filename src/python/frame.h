#pragma once
// The frame object of Python.

#include <pybind11/numpy.h>

#include <atomic>
#include <cstdint>
#include <vector>

#include "frame/simulator.h"
#include "python/bindings.h"

namespace echocine::python {

// Its memory keeps its address: arrays are views of it, also after it is filled again.
struct NativeFrame {
  Frame frame;
  int width = 0, height = 0;      // of its picture and labels, pixels
  std::uint64_t maker = 0;        // NativeSimulator::number
  std::atomic<bool> busy{false};  // being filled
};

// Copies planes into `to`'s own memory. Precondition: both are of one simulator.
void copyInPlace(const Frame& from, Frame& to);
// The rest, whose memory is new. The caller holds the interpreter's lock, because other threads may
// read it.
void moveRest(Frame& from, Frame& to);

// Output arrays by name: "intensities", "greys", "image", "labels". Throws like checkedOut(), and
// ValueError for other names and for outputs that the scene does not have.
struct OutArray {
  std::string name;
  py::array array;
};
std::vector<OutArray> checkedOutArrays(const py::dict& given, const Scene& scene);
void copyInto(const Frame& frame, const std::vector<OutArray>& out);

// Contours of a frame as a list of dicts: structure, closed, points_mm (n, 2): lateral and depth,
// visible (n,): by point, whether the picture shows the border; None if unknown.
py::list contoursOf(const std::vector<Contour>& contours, const Scene& scene);

}  // namespace echocine::python
