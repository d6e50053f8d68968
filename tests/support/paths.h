#pragma once
// Where the tests find things. Defined in one file, so that a tree elsewhere compiles the rest
// alike.

namespace echocine::support {

extern const char* const kSourceDir;   // of the project
extern const char* const kDataDir;     // data/ in it
extern const char* const kSharedDir;   // real hearts and videos, beside it; may be absent
extern const char* const kProgram;     // the built echocine
extern const char* const kSweepPlots;  // the built sweep_plots
extern const char* const kVersion;

}  // namespace echocine::support
