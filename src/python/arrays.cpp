#include "python/arrays.h"

#include <fmt/format.h>

namespace echocine::python {

namespace {

std::string shapeText(const std::vector<py::ssize_t>& shape) {
  return fmt::format("({}{})", fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
}

std::string nameOf(const py::dtype& type) {
  return py::str(static_cast<const py::handle&>(type)).cast<std::string>();
}

}  // namespace

py::array copyOf(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

std::string shown(const py::array& array) {
  return fmt::format(
      "{}, {}", shapeText(std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim())),
      nameOf(array.dtype()));
}

py::array checkedOut(const std::string& argument, const py::object& given, const py::dtype& type,
                     const std::vector<py::ssize_t>& shape) {
  const std::string accepted =
      fmt::format("accepted: a writeable array {}, {}", shapeText(shape), nameOf(type));
  if (!py::isinstance<py::array>(given))
    throw py::type_error(
        fmt::format("{}: is {}, {}", argument,
                    py::str(py::type::of(given).attr("__name__")).cast<std::string>(), accepted));
  const auto array = py::reinterpret_borrow<py::array>(given);
  const std::vector<py::ssize_t> has(array.shape(), array.shape() + array.ndim());
  if (!array.dtype().is(type) && !array.dtype().equal(type))
    throw py::type_error(fmt::format("{}: is {}, {}", argument, shown(array), accepted));
  if (has != shape)
    throw py::value_error(fmt::format("{}: is {}, {}", argument, shown(array), accepted));
  if (!array.writeable())
    throw py::value_error(fmt::format("{}: is read-only, {}", argument, accepted));
  return array;
}

}  // namespace echocine::python
