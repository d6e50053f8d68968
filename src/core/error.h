#pragma once
// The two kinds of failure, each with its exit code of the command line. Thrown only while reading,
// building or writing, never inside the parallel loops of a stage; caught once, in src/cli.

#include <stdexcept>
#include <string>

namespace echocine {

// The scene, a mesh or an argument is unusable: exit code 2. The message is one line: `file:line:
// key: fault, accepted values`.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The work itself failed (disk full, folder not writable, codec missing): exit code 1.
class JobError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Place of a value in the scene file, for messages of later stages.
struct SourcePlace {
  std::string file;
  int line = 0;
  std::string key;
};

// `file:line: key: what`; unknown parts are omitted.
std::string atPlace(const SourcePlace& place, const std::string& what);

}  // namespace echocine
