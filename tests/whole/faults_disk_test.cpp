// Disks that fill up, folders that cannot be written, and what is put in the way of a run.

#include <gtest/gtest.h>

#include <grp.h>
#include <sys/stat.h>

#include <random>

#include "support/faulty_loop.h"

namespace echocine {
namespace {

using namespace support;

class FullDiskLoop : public FaultyLoop {
 protected:
  void expectOrderlyEnd(const Outcome& outcome) const {
    expectOneLine(outcome, 1);
    EXPECT_NE(outcome.err.find("cannot be"), std::string::npos) << outcome.err;
    for (const auto& file : leftIn(out)) EXPECT_FALSE(isPart(file.first)) << file.first;
    expectOnlyWholeFiles(out, files);
  }
};

// No space from some call on: every file of the loop is the one that meets it first.
TEST_F(FullDiskLoop, AtEachFileIsOneLineAndLeavesWholeFrames) {
#ifdef ECHOCINE_SANITIZED
  constexpr long kEvery = 12;  // a start takes seconds
#else
  constexpr long kEvery = 2;
#endif
  bool manifest = false, cine = false;
  for (long step = steps.files; step > 0; step -= kEvery) {
    SCOPED_TRACE(step);
    const Outcome outcome = disturbed("full:" + std::to_string(step));
    if (outcome.code == 0) {  // no call after this one needs space
      expectSame(leftIn(out), files);
      continue;
    }
    expectOrderlyEnd(outcome);
    manifest = manifest || outcome.err.find("manifest.json: ") != std::string::npos;
    cine = cine || outcome.err.find("cine.avi: ") != std::string::npos;
    if (step % 3 == 0) expectResumes();  // space is free again
  }
#ifndef ECHOCINE_SANITIZED
  EXPECT_TRUE(manifest && cine);
#endif
}

// Bytes reach the disk before their name does: lost power leaves no whole name on half a file.
TEST_F(FullDiskLoop, NoFileIsRenamedBeforeItIsSynced) {
  Steps counted;
  ASSERT_EQ(outcomeOf(rendering(folder / "synced", {}, 2), &counted).code, 0);
  EXPECT_GT(counted.files, 0);
  EXPECT_EQ(counted.unsynced_renames, 0);
}

TEST(FullDiskHeart, TheFolderIsNamedAfterItsFilesReachTheDisk) {
  const TempFolder folder;
  Steps counted;
  const Outcome outcome =
      outcomeOf({{"heart", "--quiet", "--keyframes", "4", "-o", folder / "heart"}}, &counted);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_GT(counted.files, 100);
  EXPECT_EQ(counted.unsynced_renames, 0);
}

// What comes after the frames that were finished fails; their pictures play.
TEST_F(FullDiskLoop, ALimitOfFileSizesLeavesWholeFramesOnly) {
  for (const long bytes : {0, 1, 512, 3000, 5000, 9000, 20000}) {
    SCOPED_TRACE(bytes);
    fs::remove_all(out);
    FaultyRun run = rendering(out, {}, 2);
    run.before = [bytes] {
      const rlimit limit{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    };
    const Outcome outcome = outcomeOf(run);
    if (outcome.code == 0) continue;
    EXPECT_EQ(outcome.code, 1);
    for (const auto& file : leftIn(out)) EXPECT_FALSE(isPart(file.first)) << file.first;
    expectOnlyWholeFiles(out, files);
    expectResumes();
  }
}

// A mount of its own, seen by one shell only; where none may be made the reason is printed.
class Mounted : public FaultyLoop {
 protected:
  // %D stands for the mounted folder, %S for the scene. What is in %D/out at the end is copied.
  Outcome shell(std::string line) const {
    fs::create_directories(disk);
    for (const auto& [key, value] : {std::pair("%D", disk), {"%S", scene}, {"%O", out}})
      for (std::size_t at = 0; (at = line.find(key, at)) != std::string::npos;)
        line.replace(at, 2, "'" + value.string() + "'");
    std::string quoted;
    for (const char c : line) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return runShell("unshare -Urm sh -c '" + quoted + "'");
  }
  bool mayMount() const { return shell("mount -t tmpfs none %D").code == 0; }
  const fs::path disk = folder / "disk";
};

TEST_F(Mounted, ASmallDiskFillsAndFreedIsCompletedToTheSameBytes) {
  if (!mayMount()) GTEST_SKIP() << "this user may not mount a file system";
  std::uintmax_t bytes = 0;
  for (const auto& file : files) bytes += file.second.size();
  int filled = 0;
  for (const int percent : {10, 30, 50, 70, 90}) {
    SCOPED_TRACE(percent);
    fs::remove_all(out);
    const Outcome outcome =
        shell("mount -t tmpfs -o size=" + std::to_string(bytes * percent / 100 / 1024) +
              "k none %D; %B render %S -o %D/out --quiet; echo first $?; find %D -name \"*.part\"; "
              "mount -o remount,size=100m %D; %B render %S -o %D/out --quiet --resume; "
              "echo second $?; cp -r %D/out %O");
    EXPECT_EQ(outcome.out, "first 1\nsecond 0\n");
    EXPECT_NE(outcome.err.find("No space left on device"), std::string::npos) << outcome.err;
    filled += outcome.code == 0;
    expectSame(leftIn(out), files);
  }
  EXPECT_EQ(filled, 5);
}

TEST_F(Mounted, AHeartOnASmallDiskIsOneLineAndLeavesNothing) {
  if (!mayMount()) GTEST_SKIP() << "this user may not mount a file system";
  const Outcome outcome = shell(
      "mount -t tmpfs -o size=100k none %D; %B heart --quiet --keyframes 4 -o %D/heart; echo $?; "
      "ls -A %D");
  EXPECT_EQ(outcome.out, "1\n");
  expectOneLine({1, "", outcome.err}, 1);
  EXPECT_NE(outcome.err.find("No space left on device"), std::string::npos) << outcome.err;
}

TEST_F(Mounted, AReadOnlyDiskIsOneLine) {
  if (!mayMount()) GTEST_SKIP() << "this user may not mount a file system";
  const Outcome outcome = shell(
      "mount -t tmpfs none %D; mount -o remount,ro %D; %B render %S -o %D/out --quiet; echo $?; "
      "%B render %S -o %D --quiet; echo $?; %B heart --quiet -o %D/heart; echo $?; ls -A %D");
  EXPECT_EQ(outcome.out, "1\n1\n1\n");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 3) << outcome.err;
  EXPECT_NE(outcome.err.find("Read-only file system"), std::string::npos) << outcome.err;
}

// A finished loop turns read-only: going on says so and leaves it as it is.
TEST_F(Mounted, AFinishedLoopThatBecameReadOnlyStaysWhole) {
  if (!mayMount()) GTEST_SKIP() << "this user may not mount a file system";
  const Outcome outcome = shell(
      "mount -t tmpfs none %D; %B render %S -o %D/out --quiet; mount -o remount,ro %D; "
      "%B render %S -o %D/out --quiet --resume; echo $?; cp -r %D/out %O");
  EXPECT_EQ(outcome.out, "1\n");
  expectOneLine({1, "", outcome.err}, 1);
  expectSame(leftIn(out), files);
}

class InTheWay : public FaultyLoop {
 protected:
  Outcome render(const std::vector<std::string>& more = {}) const {
    return outcomeOf(rendering(out, more));
  }
};

TEST_F(InTheWay, AFolderThatTheUserMayNotWriteIsOneLine) {
  if (::geteuid() != 0) GTEST_SKIP() << "only the superuser can become another user";
  fs::create_directory(out);
  fs::permissions(folder.path(), fs::perms::others_read | fs::perms::others_exec,
                  fs::perm_options::add);
  FaultyRun run = rendering(out);
  run.before = [] {
    constexpr uid_t kNobody = 65534;
    if (::setgroups(0, nullptr) != 0 || ::setgid(kNobody) != 0 || ::setuid(kNobody) != 0)
      ::_exit(125);
  };
  const Outcome outcome = outcomeOf(run);
  if (outcome.code == 127) GTEST_SKIP() << "the program is in a folder that is closed to others";
  expectOneLine(outcome, 1);
  EXPECT_NE(outcome.err.find("Permission denied"), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::is_empty(out));
}

TEST_F(InTheWay, FoldersInPlaceOfFilesAreNamedBeforeTheFirstFrame) {
  for (const char* name : {"cine.avi", "manifest.json"}) {
    SCOPED_TRACE(name);
    fs::remove_all(out);
    fs::create_directories(out / name / "mine");
    for (const auto& more : {std::vector<std::string>{}, {"--resume"}}) {
      const Outcome outcome = render(more);
      expectOneLine(outcome, 1);
      EXPECT_NE(outcome.err.find(std::string(name) + ": is a folder"), std::string::npos)
          << outcome.err;
      EXPECT_FALSE(fs::exists(out / "intensity"));
    }
  }
}

// Only the frame at fault is missing afterwards, and with the folder gone the run goes on.
TEST_F(InTheWay, AFolderInPlaceOfAFrameIsNamedAndKeepsItsContents) {
  for (const char* name :
       {"intensity/frame_0001.exr", "intensity/frame_0001.exr.part", "png/frame_0002.png"}) {
    SCOPED_TRACE(name);
    fs::remove_all(out);
    fs::create_directories(out / name / "mine");
    const Outcome outcome = render();
    expectOneLine(outcome, 1);
    EXPECT_NE(outcome.err.find(name), std::string::npos) << outcome.err;
    EXPECT_TRUE(fs::exists(out / name / "mine"));
    fs::remove_all(out / name);
    expectResumes();
  }
}

TEST_F(InTheWay, AFileInPlaceOfTheFolderIsNamedAndKept) {
  folder.write("out", "mine");
  expectOneLine(render(), 1);
  expectOneLine(render({"--resume"}), 1);
  EXPECT_EQ(bytesOf(out), "mine");
}

// The loop is long enough that the folder goes while frames are still to come.
class RemovedUnderWay : public FaultyLoop {
 protected:
  RemovedUnderWay() {
    SceneText text = sceneText(1000);
    text.acquisition["beats"] = "900";
    text.signal["reference_intensity"] = "1e-7";
    folder.write("scene.toml", text.text());
  }
  // Two threads have four frames in work at most, so the first ones are in the cine by then.
  template <typename Act>
  Outcome onceFrameEight(Act act) const {
    FaultyRun run = rendering(out, {}, 2);
    run.meanwhile = [&](pid_t child) {
      while (!fs::exists(out / "intensity/frame_0008.exr") && ::kill(child, 0) == 0) ::usleep(1000);
      act();
    };
    return outcomeOf(run);
  }
};

TEST_F(RemovedUnderWay, TheFolderMovedAwayEndsInOneLine) {
  const Outcome outcome = onceFrameEight([this] { fs::rename(out, folder / "elsewhere"); });
  expectOneLine(outcome, 1);
  EXPECT_FALSE(fs::exists(out));
}

// Another folder of the same name is not written to.
TEST_F(RemovedUnderWay, AnotherFolderInItsPlaceStaysAsItIs) {
  const Outcome outcome = onceFrameEight([this] {
    fs::rename(out, folder / "elsewhere");
    fs::create_directory(out);
  });
  expectOneLine(outcome, 1);
  EXPECT_TRUE(fs::is_empty(out));
}

TEST_F(RemovedUnderWay, TheFramesFolderRemovedEndsInOneLine) {
  const Outcome outcome =
      onceFrameEight([this] { fs::rename(out / "intensity", folder / "elsewhere"); });
  expectOneLine(outcome, 1);
  EXPECT_NE(outcome.err.find("cannot be written: No such file"), std::string::npos) << outcome.err;
  EXPECT_GT(cineFrames(out / "cine.avi"), 0);
}

}  // namespace
}  // namespace echocine
