#include "python/job.h"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"
#include "core/stop.h"
#include "python/fork_guard.h"
#include "python/unlocked.h"

namespace echocine::python {

namespace py = pybind11;

namespace {

// Four looks within the 0.2 s that a user may wait for Ctrl-C. Our choice.
constexpr std::chrono::milliseconds kLook{50};
// As the command gives its own work: readers of hostile files recurse. Taken only as used.
constexpr std::size_t kStackBytes = std::size_t{64} << 20;

struct Job {
  explicit Job(const std::function<void(const Monitor&)>& what) : body(what) {}
  const std::function<void(const Monitor&)>& body;
  std::mutex mutex;
  std::condition_variable news;
  std::optional<Progress> latest;
  std::vector<std::string> warnings;
  bool ended = false;
  std::exception_ptr error;
  std::atomic<bool> stop{false};

  void run() {
    const Monitor monitor{.tell =
                              [this](const Progress& progress) {
                                const std::lock_guard lock(mutex);
                                latest = progress;
                                news.notify_one();
                              },
                          .keep_going = [this] { return !stop && !isEnding(); },
                          .warn =
                              [this](const std::string& line) {
                                const std::lock_guard lock(mutex);
                                warnings.push_back(line);
                              }};
    std::exception_ptr thrown;
    try {
      stoppable([this] { return stop.load() || isEnding(); }, [&] { body(monitor); });
    } catch (...) {
      thrown = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    error = thrown;
    ended = true;
    news.notify_one();
  }
};

void* runJobThread(void* job) {
  static_cast<Job*>(job)->run();
  return nullptr;
}

pthread_t start(Job& job) {
  pthread_attr_t attributes;
  pthread_t thread{};
  const bool begun = ::pthread_attr_init(&attributes) == 0 &&
                     ::pthread_attr_setstacksize(&attributes, kStackBytes) == 0 &&
                     ::pthread_create(&thread, &attributes, runJobThread, &job) == 0;
  ::pthread_attr_destroy(&attributes);
  if (!begun) throw JobError("no thread can be started");
  return thread;
}

// Without the lock of the interpreter. The newest progress, and whether the job has ended.
std::pair<std::optional<Progress>, bool> waitForNews(Job& job) {
  const Unlocked released;
  std::unique_lock lock(job.mutex);
  job.news.wait_for(lock, kLook, [&] { return job.ended || job.latest; });
  return {std::exchange(job.latest, std::nullopt), job.ended};
}

void tell(const py::object& progress, const Progress& p) {
  if (!progress.is_none()) progress(p.done, p.total, wordsOf(p.task).doing);
}

// Until the job has ended. What Python raised meanwhile; the first counts.
std::optional<py::error_already_set> attend(Job& job, const py::object& progress) {
  std::optional<py::error_already_set> raised;
  for (bool ended = false; !ended;) {
    const auto [latest, now_ended] = waitForNews(job);
    ended = now_ended;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (latest && !raised) tell(progress, *latest);
    } catch (py::error_already_set& error) {
      if (!raised) raised.emplace(error);
      job.stop = true;
    }
  }
  return raised;
}

// At the line that called the package's function.
void issueWarnings(const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  const py::object type = py::module_::import("echocine._errors").attr("SceneWarning");
  for (const std::string& line : lines)
    if (PyErr_WarnEx(type.ptr(), line.c_str(), 2) != 0) throw py::error_already_set();
}

// Polls for signals from inside work. Only the process's first thread receives them: it polls, and
// its helper threads read the result. No other thread waits for the interpreter's lock.
class SignalWatch {
 public:
  bool stopWanted() {
    if (stop_.load()) return true;
    if (!hears_ || std::this_thread::get_id() != mine_ || Clock::now() < next_) return false;
    next_ = Clock::now() + kLook;
    const py::gil_scoped_acquire held;
    if (PyErr_CheckSignals() != 0) {
      raised_.emplace();
      stop_ = true;
    }
    return stop_;
  }
  // For the thread that began, after the work.
  const std::optional<py::error_already_set>& raised() const { return raised_; }

 private:
  using Clock = std::chrono::steady_clock;
  const std::thread::id mine_ = std::this_thread::get_id();
  const bool hears_ = ::getpid() == ::gettid();
  Clock::time_point next_ = Clock::now() + kLook;
  std::optional<py::error_already_set> raised_;
  std::atomic<bool> stop_{false};
};

}  // namespace

void runHere(const std::function<void()>& work) {
  beginWork();
  SignalWatch watch;
  std::exception_ptr thrown;
  {
    const Unlocked released;
    try {
      stoppable([&] { return isEnding() || watch.stopWanted(); }, work);
    } catch (...) {
      thrown = std::current_exception();
    }
  }
  if (watch.raised()) throw py::error_already_set(*watch.raised());
  if (thrown) std::rethrow_exception(thrown);
}

void runJob(const py::object& progress, const std::function<void(const Monitor&)>& body) {
  beginWork();
  Job job(body);
  const pthread_t thread = start(job);
  std::optional<py::error_already_set> raised = attend(job, progress);
  {
    const Unlocked released;
    ::pthread_join(thread, nullptr);
  }
  if (raised) throw py::error_already_set(*raised);
  if (!job.error) return issueWarnings(job.warnings);
  try {
    issueWarnings(job.warnings);
  } catch (const py::error_already_set&) {  // a filter that makes errors of warnings
  }
  std::rethrow_exception(job.error);
}

}  // namespace echocine::python
