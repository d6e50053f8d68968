#pragma once
// Progress, warnings and cancellation of a long job: one type for all jobs.

#include <array>
#include <cstddef>
#include <functional>
#include <string>

namespace echocine {

// Unit of the progress.
enum class Task { reference, rendering, settings, accuracy, keyframes, comparing, hearts };

// "rendering 3/46 frames".
struct TaskWords {
  const char *doing, *unit;
};
constexpr TaskWords wordsOf(Task task) {
  constexpr std::array<TaskWords, 7> kWords{{{"measuring the loop's reference,", "frames"},
                                             {"rendering", "frames"},
                                             {"measuring", "settings"},
                                             {"trying", "settings"},
                                             {"making", "keyframes"},
                                             {"comparing", "steps"},
                                             {"computing", "hearts"}}};
  return kWords[static_cast<std::size_t>(task)];
}

struct Progress {
  Task task = Task::rendering;
  std::size_t done = 0, total = 0;  // total 0: unknown
  double seconds_left = -1;         // negative: estimated from the pace
};

struct Monitor {
  // Called from one thread at a time.
  std::function<void(const Progress&)> tell = [](const Progress&) {};
  // Called from any thread. On false the job ends as soon as it can and keeps finished results.
  std::function<bool()> keep_going = [] { return true; };
  // Warnings about valid but unlikely input, each as soon as it is known.
  std::function<void(const std::string&)> warn = [](const std::string&) {};
};

}  // namespace echocine
