#include "support/paths.h"

#include "support/fault_injector.h"

namespace echocine::support {

const char* const kSourceDir = ECHOCINE_SOURCE_DIR;
const char* const kDataDir = ECHOCINE_SOURCE_DIR "/data";
const char* const kSharedDir = ECHOCINE_SOURCE_DIR "/../shared";
const char* const kProgram = ECHOCINE_PROGRAM;
const char* const kSweepPlots = ECHOCINE_SWEEP_PLOTS;
const char* const kFaultInjector = ECHOCINE_FAULT_INJECTOR;
const char* const kVersion = ECHOCINE_VERSION;

}  // namespace echocine::support
