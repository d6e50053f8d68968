// A dataset made in this process, so that a race detector sees all of its threads.

#include <gtest/gtest.h>

#include "dataset/make_dataset.h"
#include "support/paths.h"
#include "support/run_files.h"

namespace echocine::dataset {
namespace {

using namespace support;
namespace fs = std::filesystem;

TEST(DatasetThreads, AnyNumberOfThreadsWritesTheSameFiles) {
  const TempFolder place;
  const Spec spec = readSpec(place.write(
      "threads.toml",
      "name = \"threads\"\nhearts = 2\nviews = [\"a4c\"]\nlayouts = [\"native\", \"echonet\"]\n" +
          bytesOf(fs::path(kSourceDir) / "tests/support/small_loops.toml")));
  const auto make = [&](int threads) {
    const fs::path folder = place / std::to_string(threads);
    const MakeSummary part = makePart(spec, {.folder = folder, .threads = threads}, {});
    EXPECT_EQ(part.failed, 0U);
    EXPECT_EQ(mergeParts(spec, folder, {.threads = threads}).merged, 2U);
    return filesOf(folder);
  };
  const auto one = make(1);
  EXPECT_GT(one.size(), 10U);
  EXPECT_EQ(make(3), one);
}

}  // namespace
}  // namespace echocine::dataset
