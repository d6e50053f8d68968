#pragma once
// Figures for the table of tests/laws/README.md.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace echocine::support {

// Keeps the largest size of the values that it is given, and prints it at its end as
// [ MEASURED ] Suite.Test: what 0.0123 unit. Each value is returned unchanged.
class Largest {
 public:
  Largest(std::string what, std::string unit) : what_(std::move(what)), unit_(std::move(unit)) {}
  Largest(const Largest&) = delete;
  Largest& operator=(const Largest&) = delete;
  ~Largest() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    std::printf("[ MEASURED ] %s.%s: %s %.3g %s\n", test ? test->test_suite_name() : "",
                test ? test->name() : "", what_.c_str(), largest_, unit_.c_str());
  }

  double operator()(double value) {
    largest_ = std::max(largest_, std::abs(value));
    return value;
  }

 private:
  std::string what_, unit_;
  double largest_ = 0;
};

}  // namespace echocine::support
