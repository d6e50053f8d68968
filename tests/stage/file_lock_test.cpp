// Lock files: held by one run at a time, gone after it.

#include <gtest/gtest.h>

#include <optional>

#include "core/error.h"
#include "core/file_lock.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

TEST(FileLock, OnlyOneHoldsIt) {
  const support::TempFolder folder;
  const std::filesystem::path file = folder / "work/task/lock";
  EXPECT_FALSE(isFileLocked(file));
  std::optional<FileLock> held(file);
  EXPECT_TRUE(isFileLocked(file));
  EXPECT_THROW(FileLock{file}, JobError);
  EXPECT_TRUE(isFileLocked(file));  // a refused run takes nothing away
  held.reset();
  EXPECT_FALSE(isFileLocked(file));
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_NO_THROW(FileLock{file});
}

// A killed run leaves its file without a lock.
TEST(FileLock, AFileThatIsLeftBehindIsTaken) {
  const support::TempFolder folder;
  const std::filesystem::path file = folder.write("lock", "");
  EXPECT_FALSE(isFileLocked(file));
  const FileLock held(file);
  EXPECT_TRUE(isFileLocked(file));
  EXPECT_NO_THROW(held.checkStillThere());
  std::filesystem::rename(file, folder / "elsewhere");
  EXPECT_THROW(held.checkStillThere(), JobError);
  EXPECT_NO_THROW(FileLock{file});  // of another folder in the same place
}

TEST(FileLock, ALinkIsRefused) {
  const support::TempFolder folder;
  std::filesystem::create_symlink(folder.write("target", ""), folder / "lock");
  EXPECT_THROW(FileLock{folder / "lock"}, JobError);
}

}  // namespace
}  // namespace echocine
