// What libFuzzer calls; ECHOCINE_FUZZ_TARGET is one of targets.h. An exception ends the run.

#include <cstddef>
#include <cstdint>

#include "targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  echocine::fuzz::ECHOCINE_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}
