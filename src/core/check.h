#pragma once
// Checks for programming errors. Bad input is a SceneError instead. CHECK is always on. DCHECK is
// on in debug builds and may be used in hot loops.

#include <fmt/format.h>

#include <csignal>
#include <cstdlib>

namespace echocine::detail {

template <typename A, typename B>
[[noreturn]] void checkFailed(const char* file, int line, const char* expression, const A& a,
                              const B& b) {
  fmt::print(stderr, "{}:{}: check failed: {} (left {}, right {})\n", file, line, expression, a, b);
  std::signal(SIGABRT, SIG_DFL);  // so that a handler for libraries' aborts does not take this one
  std::abort();
}

}  // namespace echocine::detail

#define ECHOCINE_CHECK_OP(a, op, b)                                                     \
  do {                                                                                  \
    if (!((a)op(b)))                                                                    \
      ::echocine::detail::checkFailed(__FILE__, __LINE__, #a " " #op " " #b, (a), (b)); \
  } while (false)

#define CHECK_EQ(a, b) ECHOCINE_CHECK_OP(a, ==, b)
#define CHECK_LT(a, b) ECHOCINE_CHECK_OP(a, <, b)
#define CHECK_LE(a, b) ECHOCINE_CHECK_OP(a, <=, b)

#ifdef NDEBUG
#define DCHECK_EQ(a, b) (void)0
#define DCHECK_LT(a, b) (void)0
#define DCHECK_LE(a, b) (void)0
#else
#define DCHECK_EQ(a, b) CHECK_EQ(a, b)
#define DCHECK_LT(a, b) CHECK_LT(a, b)
#define DCHECK_LE(a, b) CHECK_LE(a, b)
#endif
