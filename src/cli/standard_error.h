#pragma once
// Output on standard error. Nothing here throws: a closed terminal must not end a job.

#include <string_view>

namespace echocine {

// Opens /dev/null in place of closed standard streams. Otherwise an output file could get their
// number, and receive printed text.
void keepStandardStreams();

// Writes the text at once; failures are ignored.
void writeError(std::string_view text) noexcept;

// Call before the final line of a run: returns in the first calling thread, and never in others, so
// that only one line is printed.
void endsFirst() noexcept;

// If a library that must not throw, or that calls abort(), runs out of memory, the program ends
// with one line and exit code `code` instead of a crash.
void endCrashesInOneLine(int code);

}  // namespace echocine
