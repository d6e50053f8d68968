// Numbers of the command line that no run can use, and things that stand where files should: one
// line that names them, exit code 2, nothing written, nothing waited for.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "support/all_cases.h"
#include "support/loop_scene.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

class HostileArguments : public ::testing::Test {
 protected:
  // Ended by the alarm when it waits for ever.
  void expectRefused(const std::string& line, const std::string& names) {
    const Outcome outcome = runShell("ulimit -t 20; timeout 60 %B " + line);
    EXPECT_EQ(outcome.code, 2) << line << "\n" << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(names), std::string::npos) << line << "\n" << outcome.err;
    EXPECT_LT(outcome.err.size(), 2500u);
    EXPECT_FALSE(fs::exists(folder / "out")) << line;
  }
  std::string in(const char* name) const { return " '" + (folder / name).string() + "'"; }
  TempFolder folder;
};

TEST_F(HostileArguments, EveryNumberOfTheCommandLineHasFiniteBounds) {
  const std::string out = " -o" + in("out");
  const fs::path scene = writeBall(folder, ballScene(2));
  const std::vector<std::pair<std::string, std::vector<std::string>>> options{
      {"compare a b" + out,
       {"--fps", "--scale", "--pixel-aspect", "--heart-rate", "--real-ed", "--real-es",
        "--real-r-waves", "--synthetic-fps", "--synthetic-scale", "--synthetic-heart-rate",
        "--knots", "--band-mm", "--tilt", "--knot-count", "--threads"}},
      {"study" + in("scene.toml") + out, {"--budget-s", "--frames", "--repeats", "--threads"}},
      {"render" + in("scene.toml") + out, {"--tolerance-db", "--threads", "--frames"}},
      {"heart" + out, {"--hr", "--edv", "--ef", "--keyframes", "--threads"}}};
  const char* const values[] = {"nan", "inf", "1e308", "99999999999999999999", "-1e-300"};
  const std::size_t step = allCases() ? 1 : 3;  // one value in so many, another one for the next
  std::size_t next = 0;
  for (const auto& [line, names] : options)
    for (const std::string& name : names)
      for (const char* value : values)
        if (next++ % step == 0) expectRefused(line + " " + name + "=" + value, name.substr(2));
}

TEST_F(HostileArguments, AFractionOfABeatAMinuteIsAHeartRate) {
  const Outcome outcome = runShell("%B compare a b -o" + in("out") + " --heart-rate 62.5");
  EXPECT_EQ(outcome.err.find("heart-rate"), std::string::npos) << outcome.err;
  EXPECT_EQ(runShell("%B compare --help").out.find("FLOAT:INT"), std::string::npos);
}

TEST_F(HostileArguments, OptionsOfAnotherModeAreRefused) {
  const std::string out = " -o" + in("out");
  expectRefused("compare a" + out + " --scan ef=0.5:0.6:0.1 --contours", "--contours");
  expectRefused("compare a" + out + " --scan ef=0.5:0.6:0.1 --synthetic-scale 0.3",
                "--synthetic-scale");
  expectRefused("compare a" + out + " --views all --knots 1,9", "--knots");
  expectRefused("compare a b" + out + " --view a4c", "--view");
  expectRefused("compare a b" + out + " --band-mm 4", "--band-mm");
  expectRefused("compare a b" + out + " --knots 1,9 --knot-count 3", "--knots");
  expectRefused("plan a --interpolation --page p.html", "--page");
  expectRefused("plan a --interpolation --preset draft", "--preset");
  expectRefused("dataset --join a b" + out + " --threads 2", "--threads");
  expectRefused("dataset spec.toml --join a b" + out, "spec");
  expectRefused("dataset spec.toml --status a", "spec");
  expectRefused("dataset --diff a", "--diff");
  expectRefused("dataset --join a b" + out + " --merge", "--join");
  expectRefused("dataset --status a --task 1/2", "--status");
  expectRefused("dataset a" + out + " --diff b --slurm", "--diff");
}

TEST_F(HostileArguments, PipesLinksToThemselvesAndFoldersAreNoFiles) {
  writeBall(folder, ballScene(2));
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink(folder / "circle", folder / "circle");
  const std::string out = " -o" + in("out");
  for (const char* name : {"pipe", "circle"}) {
    expectRefused("render" + in(name) + out, name);
    expectRefused("compare" + in(name) + in(name) + out, name);
    fs::remove(folder / "wall_2.obj");
    fs::create_symlink(folder / name, folder / "wall_2.obj");
    expectRefused("render" + in("scene.toml") + " --quiet" + out, "wall_2.obj");
  }
}

TEST_F(HostileArguments, InputOfMegabytesIsNotRepeated) {
  const std::string long_one(3 << 20, 'x');
  for (const std::string& text :
       {long_one + " = 1\n", "[" + long_one + "]\n", "background = \"" + long_one + "\"\n",
        "[probe]\nkind = \"" + long_one + " y\"\n"}) {
    folder.write("long.toml", text);
    expectRefused("render" + in("long.toml") + " -o" + in("out"), "long.toml");
  }
}

TEST_F(HostileArguments, ASmallStackIsEnough) {
  writeBall(folder, ballScene(2));
  const Outcome outcome =
      runShell("ulimit -s 64; %B render" + in("scene.toml") + " --quiet -o" + in("out"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST_F(HostileArguments, EveryHelpHasAnExampleAndSaysWhereDocumentsAre) {
  for (const char* command : {"render", "plan", "study", "heart", "compare"}) {
    const std::string help = runShell(std::string("%B ") + command + " --help").out;
    for (const char* word : {"Example: echocine ", "Documents: ", "one per core"})
      EXPECT_NE(help.find(word), std::string::npos) << command << ": " << word;
  }
}

}  // namespace
}  // namespace echocine
