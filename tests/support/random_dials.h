#pragma once
// Laws that hold for a parametric heart of any dials.

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>

#include "core/error.h"
#include "motion/heart/heart_scene.h"
#include "support/random_world.h"

namespace echocine::support {

// Every dial is given with a chance of a half, from its full range.
inline std::map<std::string, double> randomDials(std::uint64_t number) {
  Dice dice(number);
  std::map<std::string, double> dials;
  for (const heart::Dial& dial : heart::dials()) {
    const double value = dice.number(dial.low, dial.high);
    if (dice.chance(0.5)) dials[dial.key] = value;
  }
  return dials;
}

// Calls check(dials) for hearts 0 to before `count`. Those without a shape are rejected elsewhere;
// at least one must have a shape.
template <typename Check>
void checkRandomHearts(std::uint64_t count, const Check& check) {
  int checked = 0;
  for (std::uint64_t number = 0; number < count; ++number) {
    SCOPED_TRACE(number);
    try {
      check(randomDials(number));
      ++checked;
    } catch (const SceneError&) {
    }
  }
  EXPECT_GT(checked, 0);
}

}  // namespace echocine::support
