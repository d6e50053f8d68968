// What the documents promise: links that resolve, commands and keys that the program takes, a top
// README of one screen or two. Laws of the documents, so that a renamed file, option or key fails
// here.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/paths.h"
#include "support/run_program.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = support::kSourceDir;
constexpr int kMostLinesOfTopReadme = 120, kMostRowsOfItsTables = 10;

// What a reader opens first, and every room's README. Vendored files are other people's documents.
std::vector<fs::path> documents() {
  std::vector<fs::path> found{kRoot / "CHANGELOG.md", kRoot / "README.md",
                              kRoot / ".github/CONTRIBUTING.md"};
  for (const char* top : {"src", "motion", "tests", "examples", "data"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / top))
      if (entry.path().filename() == "README.md" &&
          entry.path().parent_path().filename() != "vendor")
        found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

struct Document {
  std::string prose;              // without blocks of code
  std::vector<std::string> code;  // lines of these: indented by four, or between fences
};

Document read(const fs::path& file) {
  Document document;
  bool fenced = false;
  for (const std::string& line : support::linesOf(support::bytesOf(file))) {
    if (line.starts_with("```")) {
      fenced = !fenced;
    } else if (fenced || line.starts_with("    ")) {
      document.code.push_back(line);
    } else {
      document.prose += line + "\n";
    }
  }
  EXPECT_FALSE(fenced) << file << ": a fence is not closed";
  return document;
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at)
    found.push_back((*at)[1]);
  return found;
}

// Relative links only: what lies elsewhere cannot be checked without a network.
std::vector<std::string> linksOf(const Document& document) {
  static const std::regex kLink(R"(\]\(([^)\s]+)\))");
  std::vector<std::string> links = matches(document.prose, kLink);
  std::erase_if(links, [](const std::string& link) {
    return link.find("://") != std::string::npos || link.starts_with("mailto:");
  });
  return links;
}

std::vector<std::string> spansOf(const Document& document) {
  static const std::regex kSpan("`([^`\n]+)`");
  return matches(document.prose, kSpan);
}

// The anchors of a document's headings, as forges make them: lower case, punctuation dropped,
// spaces to hyphens.
std::set<std::string> anchorsOf(const fs::path& file) {
  std::set<std::string> anchors;
  for (const std::string& line : support::linesOf(support::bytesOf(file))) {
    if (!line.starts_with("#")) continue;
    std::string anchor;
    for (const char c : line.substr(line.find_first_not_of("# ")))
      if (c == ' ' || c == '-')
        anchor += '-';
      else if (std::isalnum(static_cast<unsigned char>(c)) || c == '_')
        anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    anchors.insert(anchor);
  }
  return anchors;
}

fs::path targetOf(const fs::path& document, const std::string& link) {
  const std::string path = link.substr(0, link.find('#'));
  return path.empty() ? document : (document.parent_path() / path).lexically_normal();
}

TEST(Documents, EveryRelativeLinkResolves) {
  for (const fs::path& file : documents())
    for (const std::string& link : linksOf(read(file))) {
      const fs::path target = targetOf(file, link);
      EXPECT_TRUE(fs::exists(target)) << file << ": " << link;
      if (const std::size_t hash = link.find('#'); hash != std::string::npos) {
        EXPECT_TRUE(anchorsOf(target).contains(link.substr(hash + 1))) << file << ": " << link;
      }
    }
}

// Whoever starts at the top README finds every other document by links alone.
TEST(Documents, EveryDocumentIsReachedFromTheTopReadme) {
  std::set<fs::path> reached{kRoot / "README.md"};
  std::vector<fs::path> next(reached.begin(), reached.end());
  while (!next.empty()) {
    const fs::path file = next.back();
    next.pop_back();
    for (const std::string& link : linksOf(read(file))) {
      fs::path target = targetOf(file, link);
      if (fs::is_directory(target)) target /= "README.md";
      if (target.extension() == ".md" && fs::exists(target) && reached.insert(target).second)
        next.push_back(target);
    }
  }
  for (const fs::path& file : documents())
    EXPECT_TRUE(reached.contains(file.lexically_normal())) << file;
}

TEST(Documents, TopReadmeIsShort) {
  const std::vector<std::string> lines = support::linesOf(support::bytesOf(kRoot / "README.md"));
  EXPECT_LE(lines.size(), kMostLinesOfTopReadme);
  int rows = 0;
  for (const std::string& line : lines) {
    rows = line.starts_with("|") ? rows + 1 : 0;
    EXPECT_LE(rows, kMostRowsOfItsTables + 2) << line;  // and its head of two
  }
}

// The words of a shell line after `echocine`; empty where the line calls something else. A comment
// ends it.
std::vector<std::string> argumentsOf(const std::string& line) {
  static const std::regex kCall(R"((?:^\s*|/|&& )echocine ((?:[a-z]|--)[^#&;<>|]*))");
  std::smatch call;
  std::vector<std::string> words;
  if (!std::regex_search(line, call, kCall)) return words;
  std::istringstream in(call[1].str());
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

const std::string& helpOf(const std::string& command) {
  static std::map<std::string, std::string> known;
  const auto [at, is_new] = known.try_emplace(command);
  if (is_new) {
    const support::Outcome help = support::runShell("%B " + command + " --help");
    EXPECT_EQ(help.code, 0) << command << ": " << help.err;
    at->second = help.out;
  }
  return at->second;
}

// Of `--name value` and `--name=value` alike; as a whole word, so that --thread is not --threads.
bool names(const std::string& help, const std::string& option) {
  const std::string name = option.substr(0, option.find('='));
  return std::regex_search(help, std::regex("(^|[\\s,])" + name + "($|[\\s,])"));
}

void expectKnownOptions(const fs::path& file, const std::vector<std::string>& words) {
  std::string command;
  if (!words[0].starts_with("-")) command = words[0];
  for (const std::string& word : words)
    if (word.starts_with("-")) {
      EXPECT_TRUE(names(helpOf(command), word)) << file << ": echocine " << command << " " << word;
    }
}

// The changes alone name what is gone.
TEST(Documents, EveryOptionShownIsOneOfItsCommand) {
  for (const fs::path& file : documents()) {
    if (file.filename() == "CHANGELOG.md") continue;
    const Document document = read(file);
    std::vector<std::string> shown = document.code;
    for (const std::string& span : spansOf(document)) shown.push_back(span);
    for (const std::string& line : shown)
      if (const auto words = argumentsOf(line); !words.empty()) expectKnownOptions(file, words);
  }
}

// Lines that a reader can paste. In an empty folder most of them fail for want of a scene, but
// never for their arguments. Hearts are left out here, since they would be written.
TEST(Documents, CommandsShownAreAcceptedByTheParser) {
  int commands = 0;
  for (const fs::path& file : documents())
    for (const std::string& line : read(file).code) {
      const std::vector<std::string> words = argumentsOf(line);
      if (words.empty() || words[0] == "heart") continue;
      std::string arguments;
      for (const std::string& word : words) arguments += word + " ";
      const support::TempFolder empty;
      const support::Outcome outcome =
          support::runShell("cd '" + empty.path().string() + "' && %B " + arguments);
      EXPECT_EQ(outcome.err.find("--help lists what is accepted"), std::string::npos)
          << file << ": " << line << "\n"
          << outcome.err;
      ++commands;
    }
  EXPECT_GT(commands, 3);
}

bool hasWord(const std::string& text, const std::string& word) {
  return std::regex_search(text, std::regex("(^|[^A-Za-z_0-9])" + word + "($|[^A-Za-z_0-9])"));
}

// `signal.tgc`, `accuracy.rays_per_beam = 32` and the like.
TEST(Documents, SceneKeysNamedAreInTheReferenceScene) {
  static const std::regex kKey(
      R"(^(?:probe|acquisition|motion|effects|signal|accuracy|output|truth|speckle)\.([a-z_0-9]+)(?: = .*)?$)");
  const std::string reference = support::bytesOf(kRoot / "examples/every_key/scene.toml");
  for (const fs::path& file : documents()) {
    if (file.filename() == "CHANGELOG.md") continue;
    for (const std::string& span : spansOf(read(file)))
      if (std::smatch key; std::regex_match(span, key, kKey) && key[1] != "json") {
        EXPECT_TRUE(hasWord(reference, key[1])) << file << ": " << span;
      }
  }
}

}  // namespace
}  // namespace echocine
