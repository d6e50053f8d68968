#pragma once
// Long work for Python: it runs on a thread of its own without the interpreter's lock, while the
// caller's thread looks after Ctrl-C and progress.

#include <pybind11/pybind11.h>

#include <functional>

#include "core/monitor.h"

namespace echocine::python {

// `progress`: None, or called as progress(done, total, what) in this thread, with what is newest;
// total 0: not known. What it raises, or Ctrl-C, stops the job and is raised here when the job has
// ended. Warnings are issued as echocine.SceneWarning when it has ended. Throws what the job
// throws. Precondition: the caller holds the interpreter's lock; the job touches no Python object.
void runJob(const pybind11::object& progress, const std::function<void(const Monitor&)>& job);

// Work of some ms, such as a frame, in this thread without the interpreter's lock: no thread is
// begun for it. Ctrl-C is looked for at checkpoints of this very thread (core/stop.h), every 50 ms;
// what it raises is raised here. Precondition and errors: those of runJob().
void runHere(const std::function<void()>& work);

}  // namespace echocine::python
