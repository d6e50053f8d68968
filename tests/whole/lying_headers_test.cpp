// A small file that promises gigabytes costs none: the program, held to little memory, refuses it
// in one line instead of running out. Inputs are those of the fuzzers.

#include <gtest/gtest.h>

#include <algorithm>

#include "support/run_program.h"
#include "support/scene_text.h"

namespace echocine {
namespace {

using namespace support;

namespace fs = std::filesystem;

const fs::path kCorpus = fs::path(kSourceDir) / "tests/fuzz/corpus";

// 4 GB of addresses, of which the libraries take one; under ASan, which takes terabytes, 512 MB at
// once.
Outcome planWithLittleMemory(const fs::path& scene) {
#ifdef ECHOCINE_SANITIZED
  const std::string limit = "export ASAN_OPTIONS=max_allocation_size_mb=512; ";
#else
  const std::string limit = "ulimit -v 4000000; ";
#endif
  return runShell(limit + "%B plan '" + scene.string() + "'");
}

void expectOneLineOfCodeTwo(Outcome outcome) {
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  if (outcome.err.starts_with("echocine: warning: "))  // that one keyframe stands still
    outcome.err.erase(0, outcome.err.find('\n') + 1);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  for (const unsigned char c : outcome.err) EXPECT_TRUE(c >= 0x20 || c == '\n') << int{c};
}

TEST(LyingHeaders, OfMeshesAreRefusedWithoutTheMemoryTheyPromise) {
  const TempFolder folder;
  int files = 0;
  for (const char* kind : {"ply", "off", "stl"})
    for (const auto& entry : fs::directory_iterator(kCorpus / kind)) {
      if (!entry.path().filename().string().starts_with("lying")) continue;
      SCOPED_TRACE(entry.path().string());
      ASSERT_LT(entry.file_size(), 1000u);
      SceneText text;
      text.addStructure("box", "blood", "\"" + entry.path().string() + "\"");
      expectOneLineOfCodeTwo(planWithLittleMemory(folder.write("scene.toml", text.text())));
      ++files;
    }
  EXPECT_GE(files, 7);
}

TEST(LyingHeaders, ScenesThatAskForTooMuchOrBreakLinesAreRefusedInOneLine) {
  for (const char* name :
       {"lines_times_samples.toml", "nested_lists.toml", "control_character.toml",
        "key_with_a_line_break.toml", "value_with_a_line_break.toml"}) {
    SCOPED_TRACE(name);
    expectOneLineOfCodeTwo(planWithLittleMemory(kCorpus / "scene" / name));
  }
}

}  // namespace
}  // namespace echocine
