#include "live/job_queue.h"

#include <algorithm>
#include <optional>

#include "core/parallel.h"

namespace echocine::live {

HttpResponse supersededResponse() {
  return {204, {}, {}};
}

JobQueue::JobQueue(int threads) : threads_(threads), thread_([this] { work(); }) {}

JobQueue::~JobQueue() {
  end();
  thread_.join();
}

void JobQueue::end() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
}

void JobQueue::push(LiveJob job, Answer answer) {
  std::optional<Answer> replaced;
  bool full = false;
  {
    const std::lock_guard lock(mutex_);
    if (job.picture) {
      const auto older = std::find_if(waiting_.begin(), waiting_.end(),
                                      [](const Entry& entry) { return entry.job.picture; });
      if (older != waiting_.end()) {
        replaced = std::move(older->answer);
        waiting_.erase(older);
      }
      superseded_ = superseded_ || gives_way_;
    }
    full = waiting_.size() >= kMostWaitingJobs;
    if (!full) waiting_.push_back({std::move(job), answer});
  }
  wake_.notify_all();
  if (replaced) (*replaced)(supersededResponse());
  if (full) answer(lineResponse(503, "too many requests are waiting"));
}

bool JobQueue::stopWanted() {
  const std::lock_guard lock(mutex_);
  return ends_ || superseded_;
}

HttpResponse JobQueue::responseOf(const LiveJob& job) {
  HttpResponse response;
  try {
    stoppable([this] { return stopWanted(); },
              [&] { withThreads(threads_, [&] { response = job.run(); }); });
  } catch (const Stopped&) {
    response = supersededResponse();
  } catch (const std::exception& error) {
    response = lineResponse(500, error.what());
  }
  return response;
}

void JobQueue::work() {
  for (;;) {
    std::optional<Entry> entry;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
      if (ends_) return;
      entry = std::move(waiting_.front());
      waiting_.pop_front();
      superseded_ = false;
      gives_way_ = entry->job.gives_way;
    }
    entry->answer(responseOf(entry->job));
    const std::lock_guard lock(mutex_);
    gives_way_ = false;
  }
}

}  // namespace echocine::live
