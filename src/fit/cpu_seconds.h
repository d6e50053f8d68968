#pragma once
// CPU time of the whole process: the cost of a search on any number of threads.

#include <ctime>

namespace echocine::fit {

inline double cpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace echocine::fit
