#pragma once
// Cooperative cancellation. The caller installs a predicate; long loops poll it at checkpoint().

#include <functional>

#include "core/error.h"

namespace echocine {

// Thrown by a checkpoint when the predicate requests a stop.
class Stopped : public JobError {
 public:
  Stopped() : JobError("stopped") {}
};

using StopQuestion = std::function<bool()>;  // true: stop

// Runs body. The checkpoints of this thread, and of all threads in its parallel loops
// (core/parallel.h), poll `wanted`, which must be thread-safe.
void stoppable(const StopQuestion& wanted, const std::function<void()>& body);

// Runs body without a predicate: its checkpoints pass. For short work that must finish, such as the
// files of one frame.
void unstoppable(const std::function<void()>& body);

// Throws Stopped if the predicate of the enclosing stoppable() is true; without one it does
// nothing. Each block of a parallel loop starts with a checkpoint. A call costs nanoseconds and
// should follow every few ms of work. Not for destructors, nor while a file is partly written in
// place.
void checkpoint();

// The predicate of this thread's checkpoints; nullptr: none.
const StopQuestion* stopQuestion();

// Installs the predicate of one thread in another that works for it, for its lifetime.
class StopScope {
 public:
  explicit StopScope(const StopQuestion* question);
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  const StopQuestion* before_;
};

}  // namespace echocine
