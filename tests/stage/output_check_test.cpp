// Places for results, checked before the work; parts of killed runs and of runs at work.

#include "core/output_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/part_file.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

std::string jobErrorOf(const std::function<void()>& check) {
  try {
    check();
  } catch (const JobError& error) {
    return error.what();
  }
  return "";
}

TEST(OutputCheck, AFileCanBeWrittenOrSaysWhyNot) {
  const TempFolder folder;
  folder.write("old.html", "old");
  fs::create_directories(folder / "taken");
  EXPECT_EQ(jobErrorOf([&] { checkOutputFile(folder / "new.html"); }), "");
  EXPECT_EQ(jobErrorOf([&] { checkOutputFile(folder / "old.html"); }), "");
  EXPECT_NE(jobErrorOf([&] { checkOutputFile(folder / "taken"); }).find("is a folder"),
            std::string::npos);
  EXPECT_NE(jobErrorOf([&] { checkOutputFile(folder / "none/new.html"); }), "");
  EXPECT_NE(jobErrorOf([&] { checkOutputFile(folder / "old.html/new.html"); }), "");
  EXPECT_EQ(bytesOf(folder / "old.html"), "old");
  std::vector<std::string> left;
  for (const auto& entry : fs::directory_iterator(folder.path()))
    left.push_back(entry.path().filename().string());
  std::sort(left.begin(), left.end());
  EXPECT_EQ(left, (std::vector<std::string>{"old.html", "taken"}));  // nothing is tried for good
}

TEST(OutputCheck, AFolderNeedNotExistButMustBePossible) {
  const TempFolder folder;
  folder.write("file", "");
  fs::create_directories(folder / "there/summary.json");
  EXPECT_EQ(jobErrorOf([&] { checkOutputFolder(folder / "a/b/c", {"summary.json"}); }), "");
  EXPECT_FALSE(fs::exists(folder / "a"));
  EXPECT_EQ(jobErrorOf([&] { checkOutputFolder(folder.path(), {"summary.json"}); }), "");
  for (const char* place : {"file", "file/below"})
    EXPECT_NE(jobErrorOf([&] { checkOutputFolder(folder / place, {}); }).find("is a file"),
              std::string::npos)
        << place;
  EXPECT_NE(jobErrorOf([&] { checkOutputFolder(folder / "there", {"summary.json"}); }), "");
}

TEST(PartFile, PartsOfKilledRunsAreRemovedAndThoseAtWorkStay) {
  const TempFolder folder;
  const fs::path target = folder / "page.html";
  const fs::path killed = folder.write("page.html.0123abcd.part", "half");
  WholeFile at_work(target);
  at_work.write(std::as_bytes(std::span("whole", 5)));
  removePartsOf(target);
  EXPECT_FALSE(fs::exists(killed));
  at_work.finish();
  EXPECT_EQ(bytesOf(target), "whole");
}

}  // namespace
}  // namespace echocine
