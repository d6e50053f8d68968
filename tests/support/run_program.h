#pragma once
// Runs the program as a user does and takes what it prints.

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <string>

#include "support/paths.h"
#include "support/temp_folder.h"

namespace echocine::support {

struct Outcome {
  int code = -1;  // exit code; 128 + signal when the program was ended by one
  std::string out, err;
};

// A shell line; %B stands for the program. Standard error is taken apart from standard output.
inline Outcome runShell(std::string line) {
  const TempFolder folder;
  const std::string program = std::string("'") + kProgram + "'";
  for (std::size_t at = 0; (at = line.find("%B", at)) != std::string::npos; at += program.size())
    line.replace(at, 2, program);
  const std::string error_file = (folder / "stderr").string();
  Outcome outcome;
  std::FILE* pipe = ::popen(("( " + line + " ) 2>'" + error_file + "'").c_str(), "r");
  std::array<char, 4096> block{};
  for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
    outcome.out.append(block.data(), n);
  const int status = ::pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.err = bytesOf(error_file);
  return outcome;
}

inline Outcome renderScene(const std::filesystem::path& scene, const std::filesystem::path& folder,
                           const std::string& more = "") {
  return runShell("%B render '" + scene.string() + "' -o '" + folder.string() + "' --quiet " +
                  more);
}

// Most memory that a run held at once, bytes. 0 when the run failed.
inline long peakMemory(const std::filesystem::path& scene, const std::filesystem::path& folder) {
  const std::string file = scene.string(), out = folder.string();
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl(kProgram, "echocine", "render", file.c_str(), "-o", out.c_str(), "--quiet", "--threads",
            "2", static_cast<char*>(nullptr));
    ::_exit(127);
  }
  int status = 0;
  rusage usage{};
  ::wait4(child, &status, 0, &usage);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? usage.ru_maxrss * 1024 : 0;
}

}  // namespace echocine::support
