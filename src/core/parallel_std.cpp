// The parallel functions on std::thread alone: for platforms without TBB, and for race detectors,
// which cannot look into the packaged TBB.

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#ifdef __linux__
#include <sched.h>
#endif

#include "core/library_threads.h"
#include "core/parallel.h"

namespace echocine {

namespace {

using Lock = std::unique_lock<std::mutex>;

struct Step {
  enum class Kind { block, ask, work, drain } kind;
  std::size_t index = 0;
  std::shared_ptr<void> result{};
  bool go_on = true;
};

// A loop that several threads work at, step by step. The pool's one mutex guards its state: blocks
// and frames are long against a lock.
class Loop {
 public:
  // Takes a step, if there is one to take now. The caller's functions run without the lock.
  bool step(Lock& lock) {
    std::optional<Step> taken = error_ ? std::nullopt : take();
    if (!taken) return false;
    ++busy_;
    lock.unlock();
    std::exception_ptr error;
    try {
      run(*taken);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    --busy_;
    if (!error)
      finish(*taken);
    else if (!error_)
      error_ = error;
    return true;
  }
  bool ended() const { return busy_ == 0 && (error_ || nothingLeft()); }
  void throwError() const {
    if (error_) std::rethrow_exception(error_);
  }

 protected:
  ~Loop() = default;

 private:
  virtual std::optional<Step> take() = 0;  // with the lock, as the next two
  virtual void finish(Step& step) = 0;
  virtual bool nothingLeft() const = 0;
  virtual void run(Step& step) const = 0;  // without the lock

  int busy_ = 0;  // threads in a step
  std::exception_ptr error_;
};

class BlockLoop final : public Loop {
 public:
  BlockLoop(std::size_t count, std::size_t grain,
            const std::function<void(std::size_t, std::size_t)>& body)
      : count_(count), grain_(grain), body_(body) {}

 private:
  std::optional<Step> take() override {
    if (nothingLeft()) return std::nullopt;
    return Step{Step::Kind::block, std::exchange(next_, next_ + std::min(grain_, count_ - next_))};
  }
  void run(Step& step) const override {
    body_(step.index, step.index + std::min(grain_, count_ - step.index));
  }
  void finish(Step&) override {}
  bool nothingLeft() const override { return next_ == count_; }

  std::size_t next_ = 0, count_, grain_;
  const std::function<void(std::size_t, std::size_t)>& body_;
};

struct OrderedCalls {
  const std::function<bool()>& keep_going;
  const std::function<std::shared_ptr<void>(std::size_t)>& work;
  const std::function<void(std::size_t, std::shared_ptr<void>)>& drain;
};

// An index is asked for, worked at and drained; from the yes to the end of the drain it is alive.
class OrderedLoop final : public Loop {
 public:
  OrderedLoop(std::size_t first, std::size_t last, std::size_t in_flight, const OrderedCalls& calls)
      : next_(first),
        last_(last),
        drained_(first),
        results_(std::min(in_flight, last > first ? last - first : 0)),
        calls_(calls) {}
  std::size_t drained() const { return drained_; }

 private:
  std::optional<Step> take() override {
    if (nothingLeft()) return std::nullopt;
    if (Result& oldest = resultOf(drained_); oldest && !draining_) {
      draining_ = true;
      return Step{Step::Kind::drain, drained_, *std::exchange(oldest, std::nullopt)};
    }
    if (agreed_) return Step{Step::Kind::work, *std::exchange(agreed_, std::nullopt)};
    if (asking_ || next_ >= last_ || next_ - drained_ >= results_.size()) return std::nullopt;
    asking_ = true;
    return Step{Step::Kind::ask, next_};
  }

  void run(Step& step) const override {
    switch (step.kind) {
      case Step::Kind::ask:
        step.go_on = calls_.keep_going();
        break;
      case Step::Kind::drain:
        calls_.drain(step.index, std::move(step.result));
        break;
      default:
        step.result = calls_.work(step.index);
    }
  }

  void finish(Step& step) override {
    switch (step.kind) {
      case Step::Kind::ask:
        asking_ = false;
        if (step.go_on)
          agreed_ = next_++;
        else
          last_ = next_;
        break;
      case Step::Kind::drain:
        draining_ = false;
        ++drained_;
        break;
      default:
        resultOf(step.index) = std::move(step.result);
    }
  }

  bool nothingLeft() const override { return drained_ >= last_; }

  using Result = std::optional<std::shared_ptr<void>>;
  Result& resultOf(std::size_t index) { return results_[index % results_.size()]; }

  std::size_t next_, last_, drained_;
  bool asking_ = false, draining_ = false;
  std::optional<std::size_t> agreed_;  // asked, not yet begun
  std::vector<Result> results_;        // as many as may be alive, each in the place of its index
  const OrderedCalls& calls_;
};

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

  void work(Loop& loop) {
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
                       [&](Loop* loop) { return loop->step(lock); });
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Loop*> loops_;
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

void workAt(Loop& loop) {
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
