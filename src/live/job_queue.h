#pragma once
// Jobs of a session, one at a time on a thread of their own. The newest picture supersedes others.

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "core/stop.h"
#include "live/http_response.h"

namespace echocine::live {

// Waiting jobs that are not superseded. Our choice: more than a page ever has.
inline constexpr std::size_t kMostWaitingJobs = 16;

// Which queue a job waits in: hearts are made beside the pictures, so that the old one beats on.
enum class Lane { pictures, hearts };

struct LiveJob {
  // Computes the response. May be cancelled by Stopped; other exceptions are not expected.
  std::function<HttpResponse()> run;
  // A later one of the same kind replaces it while it waits, and it is then answered as superseded.
  bool picture = false;
  // A later picture also cancels it while it runs.
  bool gives_way = false;
  Lane lane = Lane::pictures;
};

// 204: the picture was replaced by a newer request. No error, so that browsers do not report one.
HttpResponse supersededResponse();

class JobQueue {
 public:
  using Answer = std::function<void(HttpResponse)>;

  // Jobs run with `threads` threads (0: one per core).
  explicit JobQueue(int threads);
  // end(), and waits for the thread.
  ~JobQueue();
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  // Thread-safe. `answer` is called exactly once, from the queue's thread or from within this
  // function, unless the queue ends first. With too many waiting jobs the answer is 503.
  void push(LiveJob job, Answer answer);

  // Cancels the job that runs and drops those that wait. Returns at once.
  void end();

 private:
  struct Entry {
    LiveJob job;
    Answer answer;
  };
  void work();
  HttpResponse responseOf(const LiveJob& job);
  bool stopWanted();

  const int threads_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Entry> waiting_;
  bool ends_ = false, superseded_ = false, gives_way_ = false;  // of the job that runs
  std::thread thread_;
};

// A queue for each lane.
class JobQueues {
 public:
  explicit JobQueues(int threads) : pictures_(threads), hearts_(threads) {}
  // The jobs of both lanes end beside each other.
  ~JobQueues() {
    pictures_.end();
    hearts_.end();
  }
  void push(LiveJob job, JobQueue::Answer answer) {
    JobQueue& queue = job.lane == Lane::hearts ? hearts_ : pictures_;
    queue.push(std::move(job), std::move(answer));
  }

 private:
  JobQueue pictures_, hearts_;
};

}  // namespace echocine::live
