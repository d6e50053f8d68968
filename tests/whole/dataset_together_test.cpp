// Tasks of one dataset that begin at the same moment in a fresh folder.
//
// ECHOCINE_TOGETHER sets how many rounds.

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "support/run_files.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

// A task of eight has a heart, or none; of two threads each, so that a race detector sees them.
constexpr const char* kHead = R"(name = "together"
hearts = 3
views = ["a4c"]
layouts = ["native", "echonet"]
)";

class DatasetTogether : public testing::Test {
 protected:
  std::string making(const fs::path& from, const std::string& name,
                     const std::string& more = "") const {
    return "%B dataset '" + from.string() + "' -o '" + (place / name).string() +
           "' --threads 2 --quiet " + more;
  }

  TempFolder place;
  const fs::path spec = place.write(
      "together.toml", kHead + bytesOf(fs::path(kSourceDir) / "tests/support/small_loops.toml"));
};

TEST_F(DatasetTogether, EightTasksWorkAsOne) {
  const Outcome alone = runShell(making(spec, "alone"));
  ASSERT_EQ(alone.code, 0) << alone.err;
  const auto whole = filesOf(place / "alone");
  const char* const wanted = std::getenv("ECHOCINE_TOGETHER");
  const int rounds = wanted ? std::atoi(wanted) : 2;
  for (int round = 0; round < rounds; ++round) {
    SCOPED_TRACE(round);
    const std::string name = "together" + std::to_string(round);
    std::string script = "pids=; for k in 1 2 3 4 5 6 7 8; do " +
                         making(spec, name, "--task $k/8 & pids=\"$pids $!\"; ") +
                         "done; failed=0; for p in $pids; do wait $p || failed=1; done; "
                         "exit $failed";
    const Outcome tasks = runShell(script);
    EXPECT_EQ(tasks.code, 0) << tasks.err;
    // A killed task's temporary file goes with the merge.
    std::ofstream(place / name / "native/ec000001_a4c/cine.avi.0123abcd.part") << "half";
    const Outcome merged = runShell(making(spec, name, "--merge"));
    EXPECT_EQ(merged.code, 0) << merged.err;
    EXPECT_TRUE(filesOf(place / name) == whole);
    fs::remove_all(place / name);
  }
}

TEST_F(DatasetTogether, TwoSpecsThatRaceForAFolderDoNotMix) {
  const fs::path other = place.write("other.toml", "seed = 2\n" + bytesOf(spec));
  const Outcome both = runShell("(" + making(spec, "race") + "; echo $?) & (" +
                                making(other, "race") + "; echo $?) & wait");
  EXPECT_TRUE(both.out == "2\n0\n" || both.out == "0\n2\n") << both.out << both.err;
}

}  // namespace
}  // namespace echocine
