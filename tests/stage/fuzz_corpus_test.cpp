// Every input that a fuzzer starts from, and every one that once broke something, in the ordinary
// tests.

#include <gtest/gtest.h>

#include "fuzz/resume_scene.h"
#include "fuzz/targets.h"
#include "output/exr_stack.h"
#include "scene/names.h"
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

// A fuzzer that starts from frames which are refused at their digest sees little of the reader.
// With ECHOCINE_EXR_SEEDS set to a folder the frames are written there anew.
TEST(FuzzSeeds, WholeFramesAreTakenByTheRunThatResumes) {
  const char* const remade = std::getenv("ECHOCINE_EXR_SEEDS");
  const std::filesystem::path seeds =
      remade ? std::filesystem::path(remade)
             : std::filesystem::path(support::kSourceDir) / "tests/fuzz/corpus/exr";
  const support::TempFolder folder;
  const std::filesystem::path frame = folder / ExrStack::fileName(fuzz::kResumeFrame.frame);
  for (const auto& name : NamesOf<ExrCompression>::kAll)
    for (std::size_t c = 0; c < fuzz::kResumeChannels.size(); ++c)
      for (const bool other : {false, true}) {
        const bool is_kept = !other || name.value == ExrCompression::none;
        if (!is_kept) continue;
        const std::filesystem::path seed =
            seeds / (std::string(name.name) + (c == 0 ? "_y" : "_more") +
                     (other ? "_another_scene.exr" : ".exr"));
        SCOPED_TRACE(seed.filename().string());
        Scene scene = fuzz::resumeScene(fuzz::kResumeChannels[c]);
        scene.output.exr_compression = name.value;
        const ExrStack stack(folder.path(), scene, other ? std::string(64, 'b') : fuzz::kResumeHash,
                             fuzz::kResumeReference);
        if (remade) {
          const std::vector<float> values{1, 0.5f, 0.25f, 0, 1e-6f, 3, 2,   1,
                                          7, 1,    1,     1, 0,     0, 0.1f};
          const std::vector<std::uint32_t> ids{0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 2, 2, 2, 2, 2};
          std::vector<ChannelPlane> planes;
          for (const Channel channel : scene.output.channels)
            planes.push_back(channel == Channel::medium ? ChannelPlane{channel, {}, ids}
                                                        : ChannelPlane{channel, values, {}});
          stack.write(fuzz::kResumeFrame, planes);
          std::filesystem::copy_file(frame, seed,
                                     std::filesystem::copy_options::overwrite_existing);
        }
        std::filesystem::copy_file(seed, frame, std::filesystem::copy_options::overwrite_existing);
        EXPECT_NE(stack.existing(fuzz::kResumeFrame), "");
      }
}

INSTANTIATE_TEST_SUITE_P(EachTarget, FuzzCorpus, ::testing::ValuesIn(fuzz::kTargets),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace echocine
