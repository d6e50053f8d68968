// The parallel functions on oneTBB.

#include "core/library_threads.h"
#include "core/parallel.h"
#include "core/stop.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <utility>
#include <vector>

namespace echocine {

namespace tbb = oneapi::tbb;

namespace {

// In an arena, whichever thread it takes for it.
void execute(tbb::task_arena& arena, const std::function<void()>& body) {
  const StopQuestion* const question = stopQuestion();
  arena.execute([&] {
    const StopScope asked(question);
    body();
  });
}

// If an outer loop fails, oneTBB silently skips the rest of the loop inside it, and the code after
// that would take its work for done. A loop with its own context is complete or throws.
tbb::task_group_context contextOfItsOwn() {
  return tbb::task_group_context(tbb::task_group_context::isolated);
}

}  // namespace

void withThreads(int threads, const std::function<void()>& body) {
  const int count = threads > 0 ? threads : tbb::info::default_concurrency();
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                            static_cast<std::size_t>(count));
  tbb::task_arena arena(count);
  execute(arena, body);
}

void inThisThread(const std::function<void()>& body) {
  tbb::task_arena arena(1);
  execute(arena, body);
}

int threadCount() {
  return tbb::this_task_arena::max_concurrency();
}

void isolated(const std::function<void()>& body) {
  tbb::this_task_arena::isolate(body);
}

// Its tasks are ours to share: they run on the threads of withThreads().
int libraryThreads() {
  return 0;
}

void parallelBlocks(std::size_t count, std::size_t grain,
                    const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t blocks = (count + grain - 1) / grain;
  const StopQuestion* const question = stopQuestion();
  tbb::task_group_context alone = contextOfItsOwn();
  isolated([&] {
    tbb::parallel_for(
        std::size_t{0}, blocks,
        [&](std::size_t block) {
          const StopScope asked(question);
          checkpoint();
          const std::size_t begin = block * grain;
          body(begin, begin + grain < count ? begin + grain : count);
        },
        alone);
  });
}

std::size_t parallelOrdered(std::size_t first, std::size_t last, std::size_t in_flight,
                            const std::function<bool()>& keep_going,
                            const std::function<std::shared_ptr<void>(std::size_t)>& work,
                            const std::function<void(std::size_t, std::shared_ptr<void>)>& drain) {
  std::size_t next = first;
  std::size_t drained = first;
  // The pipeline carries numbers: of a token that owns memory it loses some when a stage throws.
  // Item i is drained before item i + in_flight begins, so each has a place of its own.
  std::vector<std::shared_ptr<void>> made(in_flight);
  const StopQuestion* const question = stopQuestion();
  tbb::task_group_context alone = contextOfItsOwn();
  tbb::parallel_pipeline(
      in_flight,
      tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                          [&](tbb::flow_control& control) -> std::size_t {
                                            if (next >= last || !keep_going()) {
                                              control.stop();
                                              return last;
                                            }
                                            return next++;
                                          }) &
          tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel,
                                                     [&](std::size_t i) {
                                                       const StopScope asked(question);
                                                       made[i % in_flight] = work(i);
                                                       return i;
                                                     }) &
          tbb::make_filter<std::size_t, void>(tbb::filter_mode::serial_in_order,
                                              [&](std::size_t i) {
                                                const StopScope asked(question);
                                                drain(i,
                                                      std::exchange(made[i % in_flight], nullptr));
                                                drained = i + 1;
                                              }),
      alone);
  return drained;
}

}  // namespace echocine
