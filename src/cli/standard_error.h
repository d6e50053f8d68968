#pragma once
// Lines on standard error. None of this throws: a terminal that is gone must not end a job.

#include <string_view>

namespace echocine {

// Opens /dev/null in place of standard streams that are closed, so that no output file gets their
// number and, with it, what is to be printed.
void keepStandardStreams();

// Writes the text at once; a failure is of no consequence.
void writeError(std::string_view text) noexcept;

// An exception that nothing could catch, as where memory runs out inside a library that promises
// not to throw, becomes one line and exit code `code` instead of a crash.
void endUncaughtInOneLine(int code);

}  // namespace echocine
