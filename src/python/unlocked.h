#pragma once
// Native work without the interpreter's lock, and the interpreter's end.
//
// A daemon thread that comes back from native work while the interpreter ends is ended by CPython
// inside of C++ frames, which aborts the process. So the module's exit function (atexit) stops what
// is at work and waits for it, and threads that come back after it never take the lock again.

#include <pybind11/pybind11.h>

namespace echocine::python {

// Gives the interpreter's lock up and takes it again at the end of the scope; there the thread
// sleeps for ever once the interpreter is ending. Precondition: the lock is held.
class Unlocked {
 public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  PyThreadState* state_;
};

// The interpreter is ending: work in progress is to stop. Thread-safe.
bool isEnding();

// Registers the exit function. Of the module's set-up.
void watchTheEnd();

}  // namespace echocine::python
