#pragma once
// Loops shared by several threads, step by step; parallel_std.cpp has the threads.

#include <algorithm>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "core/stop.h"

namespace echocine {

using Lock = std::unique_lock<std::mutex>;

struct Step {
  enum class Kind { block, ask, work, drain } kind;
  std::size_t index = 0;
  std::shared_ptr<void> result{};
  bool go_on = true;
};

// A loop shared by several threads, step by step. The pool's one mutex guards its state: blocks and
// frames are long compared with a lock.
class SharedLoop {
 public:
  // Takes a step if one is available. The caller's functions run without the lock.
  bool step(Lock& lock) {
    std::optional<Step> taken = error_ ? std::nullopt : take();
    if (!taken) return false;
    ++busy_;
    lock.unlock();
    std::exception_ptr error;
    try {
      const StopScope asked(question_);
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
  ~SharedLoop() = default;

 private:
  virtual std::optional<Step> take() = 0;  // with the lock held, like the next two
  virtual void finish(Step& step) = 0;
  virtual bool nothingLeft() const = 0;
  virtual void run(Step& step) const = 0;  // without the lock

  int busy_ = 0;                                   // threads in a step
  const StopQuestion* question_ = stopQuestion();  // of the thread that starts the loop
  std::exception_ptr error_;
};

class BlockLoop final : public SharedLoop {
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
    checkpoint();
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

// An index is agreed, processed and drained; it is live from the agreement to the end of the drain.
class OrderedLoop final : public SharedLoop {
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
  std::optional<std::size_t> agreed_;  // agreed, not yet started
  std::vector<Result> results_;        // one slot per live index
  const OrderedCalls& calls_;
};

}  // namespace echocine
