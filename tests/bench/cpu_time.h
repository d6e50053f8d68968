#pragma once
// Processor time of this process: others on the machine only disturb it by what they leave in the
// caches.

#include <time.h>

namespace echocine::bench {

inline double cpuMilliseconds() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

template <typename Work>
double millisecondsOf(Work&& work) {
  const double start = cpuMilliseconds();
  work();
  return cpuMilliseconds() - start;
}

}  // namespace echocine::bench
