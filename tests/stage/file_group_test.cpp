// Files that reach the disk together.

#include "core/file_group.h"

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using support::bytesOf;
using support::TempFolder;
namespace fs = std::filesystem;

std::span<const std::byte> bytes(const std::string& text) {
  return std::as_bytes(std::span(text));
}

std::size_t filesIn(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(FileGroup, NoTargetChangesBeforeTheGroupFinishes) {
  const TempFolder folder;
  fs::create_directories(folder / "a");
  fs::create_directories(folder / "b");
  folder.write("a/0", "before");
  FileGroup group;
  for (const char* sub : {"a", "b"})
    for (int i = 0; i < 4; ++i)
      group.add({folder / sub / std::to_string(i), bytes(sub + std::to_string(i))});
  EXPECT_EQ(bytesOf(folder / "a/0"), "before");
  EXPECT_FALSE(fs::exists(folder / "b/3"));
  group.finish();
  for (const char* sub : {"a", "b"}) {
    EXPECT_EQ(filesIn(folder / sub), 4u);
    for (int i = 0; i < 4; ++i)
      EXPECT_EQ(bytesOf(folder / sub / std::to_string(i)), sub + std::to_string(i));
  }
  group.finish();  // an empty group does nothing
}

TEST(FileGroup, WithoutFinishNoFileIsLeft) {
  const TempFolder folder;
  {
    FileGroup group;
    group.add({folder / "one", bytes("1")});
    PendingFile alone(folder / "two", bytes("2"));
    PendingFile moved = std::move(alone);
    moved = PendingFile(folder / "three", bytes("3"));
    EXPECT_EQ(filesIn(folder.path()), 2u);
  }
  EXPECT_EQ(filesIn(folder.path()), 0u);
}

TEST(FileGroup, AFailureNamesTheFileAndLeavesWholeFilesOnly) {
  const TempFolder folder;
  fs::create_directories(folder / "b");
  FileGroup group;
  for (const char* name : {"a", "b", "c"}) group.add({folder / name, bytes(name)});
  try {
    group.finish();
    ADD_FAILURE() << "a folder was replaced by a file";
  } catch (const JobError& error) {
    EXPECT_EQ(std::string(error.what()).find((folder / "b").string() + ": cannot be written: "), 0u)
        << error.what();
  }
  EXPECT_EQ(bytesOf(folder / "a"), "a");
  EXPECT_EQ(filesIn(folder.path()), 2u);
  EXPECT_THROW(PendingFile(folder / "absent/file", bytes("x")), JobError);
}

TEST(FileGroup, IsDueAtThirtyTwoFiles) {
  const TempFolder folder;
  FileGroup group;
  group.add({});  // nothing to write
  for (int i = 0; i < 32; ++i) {
    EXPECT_FALSE(group.isDue()) << i;
    group.add({folder / std::to_string(i), {}});
  }
  EXPECT_TRUE(group.isDue());
  group.finish();
  EXPECT_FALSE(group.isDue());
  EXPECT_EQ(filesIn(folder.path()), 32u);
}

}  // namespace
}  // namespace echocine
