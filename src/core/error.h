#pragma once
// The two ways a run can fail, each with the exit code of the command line. Thrown only while
// reading, building or writing, never inside the parallel loops of a stage; caught once, in
// src/cli.

#include <stdexcept>
#include <string>

namespace echocine {

// The scene, a mesh, or an argument cannot be used: exit code 2.
// The message is one line: `file:line: key: what is wrong, what is accepted`.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The work itself failed (disk full, folder not writable, codec missing): exit code 1.
class JobError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Where a value of a scene stands, so that later stages can name it in their messages.
struct SourcePlace {
  std::string file;
  int line = 0;
  std::string key;
};

// `file:line: key: what`; parts that are not known are left out.
std::string atPlace(const SourcePlace& place, const std::string& what);

}  // namespace echocine
