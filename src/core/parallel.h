#pragma once
// The only access to threads: all parallel code of EchoCine uses these functions.

#include <cstddef>
#include <functional>
#include <memory>

namespace echocine {

// Runs `body` with at most `threads` threads (0: one per core). All functions below must run
// inside.
void withThreads(int threads, const std::function<void()>& body);

// Runs `body` on this thread only. Unlike withThreads() it does not affect other threads of the
// process, so any thread may call it at any time, also inside a loop.
void inThisThread(const std::function<void()>& body);

// Number of threads the enclosing withThreads() allows.
int threadCount();

// Calls body(begin, end) for disjoint blocks of `grain` indices that cover [0, count). Blocks start
// at multiples of the grain for any thread count. A waiting thread takes no work from outside this
// loop, so a caller's scratch memory is never entered twice.
void parallelBlocks(std::size_t count, std::size_t grain,
                    const std::function<void(std::size_t, std::size_t)>& body);

// Runs body so that a thread waiting inside it takes no work from outside it.
void isolated(const std::function<void()>& body);

// Calls work(i) in parallel and drain(i, result) one at a time in order, for i = first..last-1,
// with at most `in_flight` live results, so memory is bounded. keep_going() is polled before each
// work. If it is false, items in progress are still drained, and the index after the last drained
// one is returned. The first exception of either function ends the loop and is rethrown here.
std::size_t parallelOrdered(std::size_t first, std::size_t last, std::size_t in_flight,
                            const std::function<bool()>& keep_going,
                            const std::function<std::shared_ptr<void>(std::size_t)>& work,
                            const std::function<void(std::size_t, std::shared_ptr<void>)>& drain);

}  // namespace echocine
