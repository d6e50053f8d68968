// The parallel functions on std::thread alone: for platforms without TBB, and for race detectors,
// which cannot look into the packaged TBB.

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#ifdef __linux__
#include <sched.h>
#endif

#include "core/library_threads.h"
#include "core/parallel.h"
#include "core/shared_loop.h"

namespace echocine {

namespace {

// The threads of a withThreads(). A thread that has begun a loop works at this loop only until it
// ends; the others help with any.
class Pool {
 public:
  // Starts fewer threads where the system has no more: the same results, later.
  explicit Pool(int threads) {
    try {
      while (size() < threads) helpers_.emplace_back([this] { help(); });
    } catch (const std::system_error&) {
    }
  }
  ~Pool() {
    {
      const Lock lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  int size() const { return static_cast<int>(helpers_.size()) + 1; }

  void work(SharedLoop& loop) {
    Lock lock(mutex_);
    loops_.push_back(&loop);
    changed_.notify_all();
    while (!loop.ended()) {
      if (loop.step(lock))
        changed_.notify_all();
      else
        changed_.wait(lock);
    }
    std::erase(loops_, &loop);
  }

 private:
  void help();
  // The newest loop first: it is a part of what an older one waits for.
  bool stepAny(Lock& lock) {
    return std::any_of(loops_.rbegin(), loops_.rend(),
                       [&](SharedLoop* loop) { return loop->step(lock); });
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<SharedLoop*> loops_;
  bool ending_ = false;
  std::vector<std::thread> helpers_;
};

thread_local Pool* this_pool = nullptr;

class InPool {
 public:
  explicit InPool(Pool& pool) : before_(std::exchange(this_pool, &pool)) {}
  ~InPool() { this_pool = before_; }
  InPool(const InPool&) = delete;
  InPool& operator=(const InPool&) = delete;

 private:
  Pool* before_;
};

void Pool::help() {
  const InPool inside(*this);
  Lock lock(mutex_);
  while (!ending_) {
    if (stepAny(lock))
      changed_.notify_all();
    else
      changed_.wait(lock);
  }
}

void workAt(SharedLoop& loop) {
  if (this_pool)
    this_pool->work(loop);
  else
    Pool(1).work(loop);
  loop.throwError();
}

// The processors that this process may use, which a batch system limits.
int processorCount() {
#ifdef __linux__
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return CPU_COUNT(&allowed);
#endif
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

}  // namespace

void withThreads(int threads, const std::function<void()>& body) {
  Pool pool(threads > 0 ? threads : processorCount());
  const InPool inside(pool);
  body();
}

void inThisThread(const std::function<void()>& body) {
  withThreads(1, body);
}

int threadCount() {
  return this_pool ? this_pool->size() : 1;
}

// Here a waiting thread never takes work from outside.
void isolated(const std::function<void()>& body) {
  body();
}

int libraryThreads() {
  return 1;
}

void parallelBlocks(std::size_t count, std::size_t grain,
                    const std::function<void(std::size_t, std::size_t)>& body) {
  BlockLoop loop(count, grain, body);
  workAt(loop);
}

std::size_t parallelOrdered(std::size_t first, std::size_t last, std::size_t in_flight,
                            const std::function<bool()>& keep_going,
                            const std::function<std::shared_ptr<void>(std::size_t)>& work,
                            const std::function<void(std::size_t, std::shared_ptr<void>)>& drain) {
  const OrderedCalls calls{keep_going, work, drain};
  OrderedLoop loop(first, last, in_flight, calls);
  workAt(loop);
  return loop.drained();
}

}  // namespace echocine
