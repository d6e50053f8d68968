#pragma once
// Lines on standard error. None of this throws: a terminal that is gone must not end a job.

#include <string_view>

namespace echocine {

// Opens /dev/null in place of standard streams that are closed, so that no output file gets their
// number and, with it, what is to be printed.
void keepStandardStreams();

// Writes the text at once; a failure is of no consequence.
void writeError(std::string_view text) noexcept;

// To be called before the line that a run ends with: returns in the first thread that does, and
// never in any other, so that there is one line.
void endsFirst() noexcept;

// Where memory runs out inside a library that promises not to throw, or that calls abort(), the
// program ends with one line and exit code `code` instead of a crash.
void endCrashesInOneLine(int code);

}  // namespace echocine
