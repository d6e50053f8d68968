#include "core/together.h"

#include <exception>

#include "core/parallel.h"
#include "core/stop.h"

namespace echocine {

// A stop requested between the two must not skip the second: it decides at its own checkpoints.
void together(const std::function<void()>& first, const std::function<void()>& second) {
  const StopQuestion* const question = stopQuestion();
  std::exception_ptr errors[2];
  unstoppable([&] {
    parallelBlocks(2, 1, [&](std::size_t begin, std::size_t) {
      const StopScope asked(question);
      try {
        begin == 0 ? first() : second();
      } catch (...) {
        errors[begin] = std::current_exception();
      }
    });
  });
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace echocine
