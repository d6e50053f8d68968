#pragma once
// The parts of the compiled module, one source each. Users see the pure Python package beside it
// (echocine/).

#include <pybind11/pybind11.h>

namespace echocine::python {

namespace py = pybind11;

void bindErrors(py::module_& module);
void bindMeshes(py::module_& module);
void bindScene(py::module_& module);
void bindFrame(py::module_& module);
void bindSimulator(py::module_& module);
void bindLoop(py::module_& module);
void bindRender(py::module_& module);
void bindModes(py::module_& module);
void bindPlan(py::module_& module);
void bindCompare(py::module_& module);
void bindModels(py::module_& module);
void bindFit(py::module_& module);
void bindHeartFit(py::module_& module);
void bindDataset(py::module_& module);
void bindFiles(py::module_& module);
void bindLive(py::module_& module);

}  // namespace echocine::python
