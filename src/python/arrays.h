#pragma once
// C++ memory as NumPy arrays without copies, and checks of given arrays.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <string>
#include <vector>

namespace echocine::python {

namespace py = pybind11;

// A given array, converted to float64 in C order where it is not.
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

// C order; the array keeps `owner` alive. An array without values keeps its shape.
template <typename T>
py::array viewOf(const T* data, const std::vector<py::ssize_t>& shape, const py::handle& owner) {
  return py::array(py::dtype::of<T>(), shape, data, owner);
}

// Line-major planes, `frames` of them in order, as (frames, depth, line); (depth, line) for frames
// < 0.
template <typename T>
py::array planesView(const T* data, py::ssize_t frames, py::ssize_t lines, py::ssize_t samples,
                     const py::handle& owner) {
  constexpr auto kItem = static_cast<py::ssize_t>(sizeof(T));
  std::vector<py::ssize_t> shape{samples, lines}, strides{kItem, samples * kItem};
  if (frames >= 0) {
    shape.insert(shape.begin(), frames);
    strides.insert(strides.begin(), lines * samples * kItem);
  }
  return py::array(py::dtype::of<T>(), shape, strides, data, owner);
}

// An array with its own memory.
py::array copyOf(const std::vector<double>& values);

// "(24, 3), float64"
std::string shown(const py::array& array);

// A writeable array of that type and shape, with any strides. Throws TypeError or ValueError naming
// `argument`.
py::array checkedOut(const std::string& argument, const py::object& given, const py::dtype& type,
                     const std::vector<py::ssize_t>& shape);

}  // namespace echocine::python
