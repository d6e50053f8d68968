#include "core/stage_clock.h"

namespace echocine {

std::array<double, kStages> StageClock::milliseconds() const {
  std::array<double, kStages> ms{};
  for (std::size_t s = 0; s < kStages; ++s) ms[s] = static_cast<double>(ns_[s].load()) * 1e-6;
  return ms;
}

}  // namespace echocine
