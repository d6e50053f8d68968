// What libFuzzer calls; the environment variable ECHOCINE_FUZZ_TARGET names one of targets.h. An
// exception ends the run. One program for all targets: each would link all rooms again.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "targets.h"

namespace {

const echocine::fuzz::Target* target = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* name = std::getenv("ECHOCINE_FUZZ_TARGET");
  for (const auto& one : echocine::fuzz::kTargets)
    if (name != nullptr && std::string_view(name) == one.name) target = &one;
  if (target == nullptr) {
    std::fprintf(stderr, "ECHOCINE_FUZZ_TARGET: %s; set it to one of:", name ? name : "is not set");
    for (const auto& one : echocine::fuzz::kTargets) std::fprintf(stderr, " %s", one.name);
    std::fprintf(stderr, "\n");
    std::exit(2);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  target->run({reinterpret_cast<const char*>(data), size});
  return 0;
}
