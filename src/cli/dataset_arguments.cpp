#include "cli/dataset_arguments.h"

#include <fmt/format.h>

#include <charconv>

#include "core/error.h"

namespace echocine {

std::pair<int, int> parseTask(const std::string& text) {
  std::pair<int, int> task{0, 0};
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, task.first);
  const bool slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = slash ? std::from_chars(first.ptr + 1, end, task.second) : first;
  if (!slash || second.ec != std::errc() || second.ptr != end || task.first < 1 ||
      task.first > task.second)
    throw SceneError(fmt::format(
        "--task: \"{}\" is not a part, accepted: K/N, the K-th of N parts, such as 1/8", text));
  return task;
}

std::pair<std::string, double> parseRealLoop(const std::string& text) {
  constexpr double kLeast_mm = 0.01, kMost_mm = 10;
  const std::size_t sign = text.rfind('=');
  double mm = 0;
  const char* const end = text.data() + text.size();
  const auto read = sign == std::string::npos || sign == 0
                        ? std::from_chars_result{end, std::errc::invalid_argument}
                        : std::from_chars(text.data() + sign + 1, end, mm);
  if (read.ec != std::errc() || read.ptr != end || !(mm >= kLeast_mm && mm <= kMost_mm))
    throw SceneError(fmt::format(
        "--real: \"{}\" is not a loop and a number of {:g} to {:g} mm per pixel, accepted: "
        "FILE=MM, such as real.avi=0.31",
        text, kLeast_mm, kMost_mm));
  return {text.substr(0, sign), mm};
}

}  // namespace echocine
