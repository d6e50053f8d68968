#pragma once
// Long work for Python: it runs on its own thread without the interpreter's lock, while the
// caller's thread handles Ctrl-C and progress.

#include <pybind11/pybind11.h>

#include <functional>

#include "core/monitor.h"

namespace echocine::python {

// `progress`: None, or called as progress(done, total, what) in this thread with the latest state;
// total 0: unknown. An exception it raises, or Ctrl-C, stops the job and is raised here after the
// job has ended. Warnings are issued as echocine.SceneWarning after the job. Throws what the job
// throws. Precondition: the caller holds the interpreter's lock; the job uses no Python object.
void runJob(const pybind11::object& progress, const std::function<void(const Monitor&)>& job);

// Short work of some ms, such as a frame, in this thread without the interpreter's lock and without
// a new thread. Ctrl-C is checked at checkpoints of this thread (core/stop.h) every 50 ms;
// resulting exceptions are raised here. Precondition and errors: those of runJob().
void runHere(const std::function<void()>& work);

}  // namespace echocine::python
