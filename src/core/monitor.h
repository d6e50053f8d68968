#pragma once
// How a long job tells how far it is, and is told to stop: one type for all of them.

#include <array>
#include <cstddef>
#include <functional>
#include <string>

namespace echocine {

// What is counted.
enum class Task { reference, rendering, settings, accuracy, keyframes, comparing };

// "rendering 3/46 frames".
struct TaskWords {
  const char *doing, *unit;
};
constexpr TaskWords wordsOf(Task task) {
  constexpr std::array<TaskWords, 6> kWords{{{"measuring the loop's reference,", "frames"},
                                             {"rendering", "frames"},
                                             {"measuring", "settings"},
                                             {"trying", "settings"},
                                             {"making", "keyframes"},
                                             {"comparing", "steps"}}};
  return kWords[static_cast<std::size_t>(task)];
}

struct Progress {
  Task task = Task::rendering;
  std::size_t done = 0, total = 0;  // total 0: not known before
  double seconds_left = -1;         // below 0: to be guessed from the pace so far
};

struct Monitor {
  // From one thread at a time.
  std::function<void(const Progress&)> tell = [](const Progress&) {};
  // From any thread. No: the job ends as soon as it can, and what is finished stays.
  std::function<bool()> keep_going = [] { return true; };
  // What is accepted but hardly meant, each line as soon as it is known.
  std::function<void(const std::string&)> warn = [](const std::string&) {};
};

}  // namespace echocine
