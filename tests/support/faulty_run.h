#pragma once
// Runs the program in a child process that meets a fault.

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "support/fault_injector.h"
#include "support/paths.h"
#include "support/run_program.h"

namespace echocine::support {

struct Steps {
  long files = 0, memory = 0,
       unsynced_renames = 0;  // as tests/support/fault_injector.cpp counts them
};

struct FaultyRun {
  std::vector<std::string> arguments;
  std::string fault{};                                  // of the injector, KIND:STEP
  std::function<void()> before = [] {};                 // called in the child; only system calls
  std::function<void(pid_t)> meanwhile = [](pid_t) {};  // called in the parent once it runs
  unsigned limit_s = 180;                               // of processor time
};

// A run that loops ends by SIGXCPU after its limit, a hundred times what most take. A run that
// waits forever ends by SIGALRM after ten times as long, so that other load changes no result.
inline Outcome outcomeOf(const FaultyRun& run, Steps* steps = nullptr) {
  const TempFolder folder;
  const std::string out = folder / "out", err = folder / "err", counts = folder / "steps";
  const char* options = std::getenv("ASAN_OPTIONS");
  const std::string asan = std::string(options ? options : "") + ":verify_asan_link_order=0";
  std::vector<const char*> arguments{kProgram};
  for (const std::string& argument : run.arguments) arguments.push_back(argument.c_str());
  arguments.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    ::setenv("LD_PRELOAD", kFaultInjector, 1);
    ::setenv("ASAN_OPTIONS", asan.c_str(), 1);
    ::setenv("ECHOCINE_FAULT_STEPS", counts.c_str(), 1);
    if (!run.fault.empty()) ::setenv("ECHOCINE_FAULT", run.fault.c_str(), 1);
    if (!std::freopen(out.c_str(), "w", stdout) || !std::freopen(err.c_str(), "w", stderr))
      ::_exit(126);
    run.before();
    const rlimit processor{run.limit_s, run.limit_s + 60};
    ::setrlimit(RLIMIT_CPU, &processor);
    ::alarm(10 * run.limit_s);
    ::execv(kProgram, const_cast<char* const*>(arguments.data()));
    ::_exit(127);
  }
  run.meanwhile(child);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (steps) std::ifstream(counts) >> steps->files >> steps->memory >> steps->unsynced_renames;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), bytesOf(out),
          bytesOf(err)};
}

inline bool hasEnded(pid_t child) {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
         info.si_pid == child;
}

// Processor time of a process that runs, s; below 0 when it has ended.
inline double usedBy_s(pid_t child) {
  clockid_t clock{};
  timespec used{};
  if (hasEnded(child) || ::clock_getcpuclockid(child, &clock) != 0 ||
      ::clock_gettime(clock, &used) != 0)
    return -1;
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

}  // namespace echocine::support
