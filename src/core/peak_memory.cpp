#include "core/peak_memory.h"

#include <sys/resource.h>

namespace echocine {

double peakMemory_bytes() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  return 1024.0 * static_cast<double>(used.ru_maxrss);  // Linux counts kB
}

}  // namespace echocine
