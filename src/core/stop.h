#pragma once
// How long work is stopped inside its parts. Who runs it lends a question; the work asks it at its
// checkpoints, without knowing whose it is.

#include <functional>

#include "core/error.h"

namespace echocine {

// Thrown by a checkpoint: the work was told to stop.
class Stopped : public JobError {
 public:
  Stopped() : JobError("stopped") {}
};

using StopQuestion = std::function<bool()>;  // yes: stop

// Runs body. The checkpoints of this thread, and of all threads that work at its parallel loops
// (core/parallel.h), ask `wanted`, which any of them may call at any time.
void stoppable(const StopQuestion& wanted, const std::function<void()>& body);

// Runs body without a question: its checkpoints pass. For short work that has to end whole, such as
// the files of one frame.
void unstoppable(const std::function<void()>& body);

// Throws Stopped where the enclosing stoppable() answers yes; outside of one it does nothing. Each
// block of a parallel loop begins with one. Costs nanoseconds: to be called every some ms of work.
// Not for destructors, nor while files are half written in place.
void checkpoint();

// The question that a thread's checkpoints ask; nullptr: none.
const StopQuestion* stopQuestion();

// Lends the question of one thread to another that works for it, while it lives.
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
