#pragma once
// Native work without the interpreter's lock, and the end of the interpreter.
//
// CPython ends a daemon thread that returns from native work during shutdown inside of C++ frames,
// which aborts the process. So the module's exit function (atexit) stops running work and waits for
// it, and threads that return later never take the lock again.

#include <pybind11/pybind11.h>

namespace echocine::python {

// Releases the interpreter's lock and takes it again at the end of the scope; during shutdown the
// thread sleeps there forever. Precondition: the lock is held.
class Unlocked {
 public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  PyThreadState* state_;
};

// Is the interpreter ending, so that running work should stop? Thread-safe.
bool isEnding();

// Registers the exit function. Called by the module's set-up.
void watchTheEnd();

}  // namespace echocine::python
