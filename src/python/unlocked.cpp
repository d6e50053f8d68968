#include "python/unlocked.h"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace echocine::python {

namespace py = pybind11;

namespace {

// A job that does not stop is not waited for longer. Our choice.
constexpr std::chrono::seconds kPatience{10};

std::atomic<bool> ending{false};

// Threads that are in native work without the interpreter's lock.
class Workers {
 public:
  void add(int more) {
    {
      const std::lock_guard lock(mutex_);
      count_ += more;
    }
    fewer_.notify_all();
  }
  void waitUntilNone() {
    std::unique_lock lock(mutex_);
    fewer_.wait_for(lock, kPatience, [this] { return count_ == 0; });
  }
  // Around a fork: the child has none of them.
  void hold() { mutex_.lock(); }
  void release() { mutex_.unlock(); }
  void releaseInChild() {
    count_ = 0;
    mutex_.unlock();
  }

 private:
  std::mutex mutex_;
  std::condition_variable fewer_;
  int count_ = 0;
};
Workers workers;

// Holds no lock while it waits, so threads that are coming back can take it.
void stopWork() {
  ending = true;
  PyThreadState* const state = PyEval_SaveThread();
  workers.waitUntilNone();
  PyEval_RestoreThread(state);
}

}  // namespace

Unlocked::Unlocked() : state_(PyEval_SaveThread()) {
  workers.add(1);
}

// The count falls after the lock is held: until then the exit function waits.
Unlocked::~Unlocked() {
  if (ending) {
    workers.add(-1);
    for (;;) ::pause();
  }
  PyEval_RestoreThread(state_);
  workers.add(-1);
}

bool isEnding() {
  return ending;
}

void watchTheEnd() {
  ::pthread_atfork([] { workers.hold(); }, [] { workers.release(); },
                   [] { workers.releaseInChild(); });
  py::module_::import("atexit").attr("register")(py::cpp_function(&stopWork));
}

}  // namespace echocine::python
