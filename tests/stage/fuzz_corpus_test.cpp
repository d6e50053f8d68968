// Every input that a fuzzer starts from, and every one that once broke something, in the ordinary
// tests.

#include <gtest/gtest.h>

#include "fuzz/targets.h"
#include "support/paths.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

class FuzzCorpus : public ::testing::TestWithParam<fuzz::Target> {};

TEST_P(FuzzCorpus, BreaksNothing) {
  const fuzz::Target& target = GetParam();
  const std::filesystem::path folder =
      std::filesystem::path(support::kSourceDir) / "tests/fuzz/corpus" / target.name;
  int inputs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().filename().string());
    const std::string bytes = support::bytesOf(entry.path());
    EXPECT_NO_THROW(target.run(bytes));
    ++inputs;
  }
  EXPECT_GE(inputs, 3);
}

INSTANTIATE_TEST_SUITE_P(EachTarget, FuzzCorpus, ::testing::ValuesIn(fuzz::kTargets),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace echocine
