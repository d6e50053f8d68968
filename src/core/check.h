#pragma once
// Checks for programming errors. Bad input is a SceneError instead. CHECK is always on. DCHECK is
// on in debug builds and may be used in hot loops.

#include <string>
#include <type_traits>

namespace echocine::detail {

[[noreturn]] void checkFailed(const char* file, int line, const char* expression,
                              const std::string& a, const std::string& b);

std::string operandText(bool value);
std::string operandText(long long value);
std::string operandText(unsigned long long value);
std::string operandText(double value);

template <typename T>
std::string operandOf(T value) {
  if constexpr (std::is_same_v<T, bool>)
    return operandText(value);
  else if constexpr (std::is_floating_point_v<T>)
    return operandText(static_cast<double>(value));
  else if constexpr (std::is_signed_v<T>)
    return operandText(static_cast<long long>(value));
  else
    return operandText(static_cast<unsigned long long>(value));
}

}  // namespace echocine::detail

#define ECHOCINE_CHECK_OP(a, op, b)                                          \
  do {                                                                       \
    if (!((a)op(b)))                                                         \
      ::echocine::detail::checkFailed(__FILE__, __LINE__, #a " " #op " " #b, \
                                      ::echocine::detail::operandOf(a),      \
                                      ::echocine::detail::operandOf(b));     \
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
