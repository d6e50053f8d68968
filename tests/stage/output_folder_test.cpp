// The folder of a run is made, tried, and freed of earlier runs' files and of nothing else.

#include "output/output_folder.h"

#include "output_fixture.h"

namespace echocine {
namespace {

using test::messageOf;
using test::TempFolder;

OutputSettings withPng(bool png) {
  OutputSettings settings;
  settings.png = png;
  return settings;
}

// What a run of three frames leaves, what an interrupted one leaves, and what is the user's own.
void fillFolder(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "intensity");
  std::filesystem::create_directories(folder / "png");
  std::filesystem::create_directories(folder / "truth");
  for (const char* name : {"cine.avi",
                           "cine.avi.part",
                           "manifest.json",
                           "notes.txt",
                           "intensity/frame_0000.exr",
                           "intensity/frame_0001.exr",
                           "intensity/frame_0002.exr",
                           "intensity/frame_0001.exr.part",
                           "intensity/frame_12345.exr",
                           "intensity/frame_mine.exr",
                           "intensity/frame_0000.exr.bak",
                           "intensity/other.exr",
                           "png/frame_0000.png",
                           "png/frame_0002.png",
                           "png/frame_0000.png.part",
                           "png/figure.png",
                           "truth/labels_0001.png",
                           "truth/labels_0002.png",
                           "truth/contours_0002.json",
                           "truth/labels.json",
                           "truth/function.json",
                           "truth/mine.json"})
    test::putBytes(folder / name, "x");
}

std::vector<std::string> listing(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) names.push_back(entry.path().lexically_relative(folder).string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(OutputFolder, MakesWhatTheSettingsAskForAndLeavesNoTrial) {
  const TempFolder temp;
  { const OutputFolder folder(temp / "new/run", withPng(false), false); }
  EXPECT_TRUE(std::filesystem::is_directory(temp / "new/run/intensity"));
  EXPECT_FALSE(std::filesystem::exists(temp / "new/run/png"));
  EXPECT_TRUE(listing(temp.path()).empty());
  const OutputFolder with_png(temp / "new/run", withPng(true), false);
  EXPECT_TRUE(std::filesystem::is_directory(with_png.png()));
}

TEST(OutputFolder, RemovesTheManifestAtOnceAndNothingElse) {
  const TempFolder temp;
  fillFolder(temp.path());
  const auto before = listing(temp.path());
  const OutputFolder folder(temp.path(), withPng(false), true);
  EXPECT_FALSE(std::filesystem::exists(folder.manifest()));
  EXPECT_EQ(listing(temp.path()).size(), before.size() - 1);
}

TEST(OutputFolder, NewRunRemovesEveryFrameAndCineOfEarlierRuns) {
  const TempFolder temp;
  fillFolder(temp.path());
  OutputFolder(temp.path(), withPng(false), false).removeStale(2);
  const std::vector<std::string> left{"intensity/frame_0000.exr.bak",
                                      "intensity/frame_mine.exr",
                                      "intensity/other.exr",
                                      "notes.txt",
                                      "png/figure.png",
                                      "truth/mine.json"};
  EXPECT_EQ(listing(temp.path()), left);
}

TEST(OutputFolder, ResumedRunKeepsTheFramesOfItsLoop) {
  const TempFolder temp;
  fillFolder(temp.path());
  OutputFolder(temp.path(), withPng(false), true).removeStale(2);
  const std::vector<std::string> left{"cine.avi",
                                      "intensity/frame_0000.exr",
                                      "intensity/frame_0000.exr.bak",
                                      "intensity/frame_0001.exr",
                                      "intensity/frame_mine.exr",
                                      "intensity/other.exr",
                                      "notes.txt",
                                      "png/figure.png",
                                      "png/frame_0000.png",
                                      "truth/labels_0001.png",
                                      "truth/mine.json"};
  EXPECT_EQ(listing(temp.path()), left);
}

TEST(OutputFolder, RefusesAFileInPlaceOfAFolder) {
  const TempFolder temp;
  test::putBytes(temp / "file", "");
  const std::string itself =
      messageOf<JobError>([&] { OutputFolder(temp / "file", withPng(false), false); });
  EXPECT_NE(itself.find("file: is a file, a folder is needed"), std::string::npos) << itself;
  const std::string below =
      messageOf<JobError>([&] { OutputFolder(temp / "file/run", withPng(false), false); });
  EXPECT_NE(below.find("Not a directory"), std::string::npos) << below;
  test::putBytes(temp / "intensity", "");
  EXPECT_THROW(OutputFolder(temp.path(), withPng(false), false), JobError);
}

TEST(OutputFolder, RefusesWhereNothingCanBeWritten) {
  const std::string message =
      messageOf<JobError>([] { OutputFolder("/proc/echocine", withPng(false), false); });
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_THROW(OutputFolder("/proc", withPng(false), false), JobError);
  const TempFolder temp;
  EXPECT_THROW(
      {
        const test::FullDisk full(0);
        OutputFolder(temp.path(), withPng(false), false);
      },
      JobError);
}

}  // namespace
}  // namespace echocine
