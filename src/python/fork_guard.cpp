#include "python/fork_guard.h"

#include <pthread.h>

#include <atomic>

#include "core/error.h"

namespace echocine::python {

namespace {

std::atomic<bool> worked{false}, orphaned{false};

}  // namespace

void watchForks() {
  ::pthread_atfork(nullptr, nullptr, [] { orphaned = worked.load(); });
}

void beginWork() {
  if (orphaned)
    throw JobError(
        "this process was forked after echocine was used, so echocine's threads are missing; "
        "accepted: "
        "the start method \"spawn\" or \"forkserver\" (multiprocessing.get_context), or a first "
        "use "
        "of echocine after the fork");
  worked = true;
}

}  // namespace echocine::python
