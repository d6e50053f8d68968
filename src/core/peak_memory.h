#pragma once
// Memory that this process has used.

namespace echocine {

// The largest resident memory so far, bytes.
double peakMemory_bytes();

}  // namespace echocine
