// Man pages and completions name what the program accepts, and help says what a newcomer needs.

#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;

const std::vector<std::string> kCommands{"render", "view",    "plan",    "study",   "live",
                                         "mmode",  "heart",   "dataset", "compare", "fit",
                                         "export", "doppler", "archive"};

std::string helpOf(const std::string& command) {
  return runShell("%B " + command + " --help").out;
}

// "--output" and the like, at the head of a line of help: not those that descriptions mention.
std::set<std::string> optionsOf(const std::string& help) {
  std::set<std::string> options;
  const std::regex head("(?:^|\n) +(?:-[a-z],)?(--[a-z][a-z-]*)");
  for (std::sregex_iterator it(help.begin(), help.end(), head), end; it != end; ++it)
    options.insert((*it)[1]);
  return options;
}

// Without roff's changes of font and its escapes.
std::string plainText(const std::string& roff) {
  std::string text = std::regex_replace(roff, std::regex("\\\\f[BIR]"), " ");
  text.erase(std::remove(text.begin(), text.end(), '\\'), text.end());
  return text;
}

// A word by itself, so that --frame is not found in --frames.
bool names(const std::string& text, const std::string& word) {
  return std::regex_search(text, std::regex("(^|[^a-z-])" + word + "($|[^a-z-])"));
}

class SelfDescription : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    EXPECT_EQ(runShell("%B --describe-into '" + folder_->path().string() + "'").code, 0);
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string text(const std::string& file) { return bytesOf(*folder_ / file.c_str()); }
  static inline TempFolder* folder_ = nullptr;
};

TEST_F(SelfDescription, EveryCommandAndOptionOfHelpIsInManPagesAndCompletions) {
  const std::string bash = text("echocine.bash"), zsh = text("_echocine");
  for (const std::string& command : kCommands) {
    EXPECT_TRUE(names(plainText(text("echocine.1")), command));
    const std::string man = plainText(text("echocine-" + command + ".1"));
    const std::set<std::string> options = optionsOf(helpOf(command));
    EXPECT_GE(options.size(), 6u) << command;
    const std::string in_bash = bash.substr(bash.find("    " + command + ") words="));
    const std::string in_zsh = zsh.substr(zsh.find("    " + command + ")\n"));
    for (const std::string& option : options) {
      EXPECT_TRUE(names(man, option)) << command << " " << option;
      EXPECT_TRUE(names(in_bash.substr(0, in_bash.find('\n')), option)) << command << option;
      EXPECT_TRUE(names(in_zsh.substr(0, in_zsh.find(";;")), option)) << command << option;
    }
  }
}

// What bash offers behind `echocine COMMAND OPTION `.
std::string offered(const std::filesystem::path& script, const std::string& command,
                    const std::string& option) {
  return runShell("bash -c 'source " + script.string() + "; COMP_WORDS=(echocine " + command + " " +
                  option + " \"\"); COMP_CWORD=3; _echocine; echo \"${COMPREPLY[*]}\"'")
      .out;
}

TEST_F(SelfDescription, CompletionOffersTheValuesOfChoices) {
  const std::filesystem::path bash = *folder_ / "echocine.bash";
  const std::string views = "a4c a2c a3c plax psax-base psax-mid psax-apex subcostal tee-4c\n";
  EXPECT_EQ(offered(bash, "heart", "--view"), views);
  EXPECT_EQ(offered(bash, "compare", "--view"), views);
  EXPECT_EQ(offered(bash, "heart", "--look"),
            "paper clean scanner smooth contrast sharp portable faint\n");
  EXPECT_EQ(offered(bash, "render", "--preset"), "draft standard fine reference\n");
  EXPECT_EQ(offered(bash, "plan", "--preset"), "draft standard fine reference\n");
  const std::string zsh = text("_echocine");
  EXPECT_NE(zsh.find(":value:(a4c a2c a3c plax psax-base psax-mid psax-apex subcostal tee-4c)"),
            std::string::npos);
  EXPECT_NE(zsh.find(":value:(draft standard fine reference)"), std::string::npos);
}

TEST_F(SelfDescription, NoCommandOfHelpIsMissedHere) {
  const std::string help = runShell("%B --help").out;
  const std::string list = help.substr(help.find("Subcommands:"));
  EXPECT_EQ(std::count(list.begin(), list.end(), '\n') >= 6, true);
  const std::regex head("\n  ([a-z]+) ");
  std::set<std::string> found;
  for (std::sregex_iterator it(list.begin(), list.end(), head), end; it != end; ++it)
    found.insert((*it)[1]);
  EXPECT_EQ(found, std::set<std::string>(kCommands.begin(), kCommands.end()));
}

// As bash itself calls it.
TEST_F(SelfDescription, BashCompletesCommandsOptionsAndWords) {
  const auto completed = [&](const std::string& words, int at) {
    return runShell("bash -c 'source " + (*folder_ / "echocine.bash").string() + "; COMP_WORDS=(" +
                    words + "); COMP_CWORD=" + std::to_string(at) +
                    "; _echocine; echo \"${COMPREPLY[*]}\"'")
        .out;
  };
  EXPECT_EQ(completed("echocine he", 1), "heart\n");
  EXPECT_EQ(completed("echocine heart --rul", 2), "--rule\n");
  EXPECT_EQ(completed("echocine heart --rule vol", 3), "volumes\n");
}

TEST(Help, OfEveryCommandHasAnExampleTheDocumentsAndTheThreadsThatItTakes) {
  for (const std::string& command : kCommands) {
    const std::string help = helpOf(command);
    EXPECT_TRUE(names(help, "Example: echocine " + command)) << command;
    EXPECT_NE(help.find("Documents: "), std::string::npos) << command;
    EXPECT_TRUE(std::regex_search(help, std::regex("--threads[\\s\\S]{0,200}one per core")))
        << command;
    EXPECT_NE(help.find("--quiet"), std::string::npos) << command;
  }
}

}  // namespace
}  // namespace echocine
