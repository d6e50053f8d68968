#pragma once
// Threads of libraries that create TBB tasks.

namespace echocine {

// Number of threads for such a library (Embree): 0 for those of withThreads(), or 1 without TBB.
int libraryThreads();

}  // namespace echocine
