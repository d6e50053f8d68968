#include "core/check.h"

#include <fmt/format.h>

#include <csignal>
#include <cstdlib>

namespace echocine::detail {

void checkFailed(const char* file, int line, const char* expression, const std::string& a,
                 const std::string& b) {
  fmt::print(stderr, "{}:{}: check failed: {} (left {}, right {})\n", file, line, expression, a, b);
  std::signal(SIGABRT, SIG_DFL);  // so that a handler for libraries' aborts does not take this one
  std::abort();
}

std::string operandText(bool value) {
  return fmt::to_string(value);
}

std::string operandText(long long value) {
  return fmt::to_string(value);
}

std::string operandText(unsigned long long value) {
  return fmt::to_string(value);
}

std::string operandText(double value) {
  return fmt::to_string(value);
}

}  // namespace echocine::detail
