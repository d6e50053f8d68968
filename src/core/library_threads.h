#pragma once
// Threads of libraries that bring TBB tasks of their own.

namespace echocine {

// How many threads such a library (Embree) may use: 0 for those of withThreads(), or 1 where
// nothing else runs on TBB.
int libraryThreads();

}  // namespace echocine
