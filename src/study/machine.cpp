#include "study/machine.h"

#include <fstream>
#include <thread>

namespace echocine {

// Times mean little without the machine they were taken on: the name goes into study.json.
std::string processorName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) {
      const std::size_t at = line.find(": ");
      if (at != std::string::npos) return line.substr(at + 2);
    }
  return "unknown";
}

int processorCores() {
  return static_cast<int>(std::thread::hardware_concurrency());
}

}  // namespace echocine
