// echocine view.

#include <gtest/gtest.h>

#include <algorithm>

#include "support/loop_scene.h"
#include "support/page_data.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;

class ViewCommand : public ::testing::Test {
 protected:
  ViewCommand() { writeBallMeshes(folder); }
  Outcome view(const SceneText& text, const std::string& more = "") {
    const std::string scene = folder.write("scene.toml", text.text()).string();
    return runShell("%B view '" + scene + "' -o '" + page.string() + "' " + more);
  }
  TempFolder folder;
  const std::filesystem::path page = folder / "page.html";
};

TEST_F(ViewCommand, WritesAPageAndSaysWhatIsSeen) {
  const Outcome outcome = view(ballScene(4));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("shows 3 of 3 structures"), std::string::npos) << outcome.out;
  const nlohmann::json data = dataOf(bytesOf(page));
  EXPECT_EQ(data["view"]["structures"].size(), 3u);
  EXPECT_EQ(data["view"]["structures"][1]["medium"], "blood");
}

TEST_F(ViewCommand, QuietSaysOnlyThatNothingIsSeen) {
  SceneText text = ballScene(4);
  text.setProbe("axis", "[0, 0, -1]");
  const Outcome loud = view(text);
  EXPECT_NE(loud.out.find("The sector shows no structure: seen from the probe"), std::string::npos)
      << loud.out;
  const Outcome quiet = view(text, "--quiet");
  EXPECT_EQ(quiet.code, 0);
  EXPECT_EQ(quiet.out, "");
  EXPECT_TRUE(quiet.err.starts_with("echocine: warning: nothing can be seen")) << quiet.err;
  EXPECT_EQ(std::count(quiet.err.begin(), quiet.err.end(), '\n'), 1) << quiet.err;
  EXPECT_FALSE(dataOf(bytesOf(page))["view"]["sees_any"]);
}

TEST_F(ViewCommand, AnUnusableSceneWritesNothing) {
  SceneText text = ballScene(4);
  text.setProbe("lines", "-3");
  const Outcome outcome = view(text);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("probe.lines"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(page));
  EXPECT_EQ(view(ballScene(4), "--threads 9999").code, 2);
  const std::string scene = folder.write("scene.toml", ballScene(4).text()).string();
  EXPECT_EQ(runShell("%B view '" + scene + "' -o /no/such/folder/page.html").code, 1);
  EXPECT_EQ(runShell("%B view '" + scene + "'").code, 2);
}

TEST_F(ViewCommand, PlanWritesThePageToo) {
  const std::string scene = folder.write("scene.toml", ballScene(4).text()).string();
  const Outcome outcome = runShell("%B plan '" + scene + "' --page '" + page.string() + "'");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(dataOf(bytesOf(page))["view"]["structures"].size(), 3u);
}

}  // namespace
}  // namespace echocine
