// Which view a loop shows and whose heart, found by a population of hearts; and what is told of it.
// All views of three hearts: tests/bench/views_main.cpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/parallel.h"
#include "fit/dial_scan.h"
#include "fit/view_ranking.h"
#include "support/all_cases.h"
#include "support/page_data.h"
#include "support/run_program.h"
#include "support/temp_folder.h"
#include "support/view_loops.h"

namespace echocine::fit {

using namespace echo;
namespace {

using namespace support;

constexpr double kConfident = 0.1;

ViewsOptions optionsOf(const char* views, const char* dials = "") {
  ViewsOptions options;
  options.side.ed_frame = 0;
  options.views = parseViews(views);
  options.dials = parseDials(dials);
  return options;
}

double dialOf(const ViewRanking& ranking, const char* key) {
  for (std::size_t a = 0; a < ranking.population.size(); ++a)
    if (ranking.population[a].range.key == key) return ranking.views.front().heart.values[a];
  return 0;
}

// A heart of EF 0.45 and 150 mL sinks into noise, under another scanner's media, gain, grey curve
// and speckle. A view that is told with confidence is right, and of noise alone none is. The heart
// comes with it: bounds are twice those of a scan, whose steps are finer and whose wall and rate
// are given.
TEST(CompareViewRanking, AViewToldWithConfidenceIsRight) {
  const EchoLoop clear = scannedLoop(sceneOf(Family::shipped, View::a2c), 12, 5);
  int confident = 0;
  withThreads(2, [&] {
    for (const double contrast : casesOf<double>({1.0, 0.0, 0.1}, 2)) {
      EchoLoop real = clear;
      for (std::size_t n = 0; n < real.video.frames.size(); ++n)
        for (std::size_t i = 0; i < real.video.frames[n].size(); ++i) {
          std::uint8_t& grey = real.video.frames[n][i];
          const double noise = normalFromHashes(hashOf(n, i, 61), hashOf(n, i, 62));
          grey = static_cast<std::uint8_t>(std::clamp(
              128 + contrast * (grey - 128.0) + (contrast < 1 ? 40 * noise : 0), 0.0, 255.0));
        }
      // In noise one dial is sought, which takes a quarter of the hearts.
      const ViewRanking ranking = rankViews(
          real, contrast == 1 ? optionsOf("a4c,a2c") : optionsOf("a4c,a2c,psax-mid", "ef=0.45"));
      const ViewFound& best = ranking.views.front();
      std::printf("contrast %.1f: %s, V %.3f, D %.3f, confidence %.3f, EDV %.0f mL\n", contrast,
                  keyOf(best.view), best.heart.left, best.heart.found.discrepancy,
                  ranking.confidence, dialOf(ranking, "edv"));
      EXPECT_TRUE(std::is_sorted(
          ranking.views.begin(), ranking.views.end(),
          [](const ViewFound& a, const ViewFound& b) { return a.heart.left < b.heart.left; }));
      if (contrast == 1) {
        EXPECT_NEAR(dialOf(ranking, "ef"), 0.45, 0.06);
        EXPECT_NEAR(dialOf(ranking, "edv"), 150, 0.12 * 150);
      }
      if (ranking.confidence < kConfident) continue;
      EXPECT_GT(contrast, 0);
      EXPECT_EQ(best.view, View::a2c);
      ++confident;
    }
  });
  EXPECT_GE(confident, 1);
}

// The same bytes by one thread and by two; and pages, tables and files agree.
TEST(CompareViewRanking, FilesAgreeWhateverTheThreads) {
  const EchoLoop real = scannedLoop(sceneOf(Family::shipped, View::psax_mid), 10, 6);
  TempFolder folder;
  for (const int threads : {1, 2})
    withThreads(threads, [&] {
      ViewRanking ranking = rankViews(real, optionsOf("a4c,psax-mid", "ef=0.45,hr=72"));
      ranking.cpu_ms = ranking.nodes_ms = 0;  // the clock's, not the loop's
      for (ViewFound& view : ranking.views)
        if (view.heart.tilt) view.heart.tilt->cpu_ms = 0;
      writeViews(ranking, folder / std::to_string(threads));
    });
  for (const char* name : {"views.csv", "views.json", "views.html"})
    EXPECT_TRUE(bytesOf(folder / "1" / name) == bytesOf(folder / "2" / name)) << name;
  const nlohmann::json file = nlohmann::json::parse(bytesOf(folder / "1/views.json")),
                       page = dataOf(bytesOf(folder / "1/views.html"));
  EXPECT_EQ(file["best"], "psax-mid");
  ASSERT_EQ(file["views"].size(), 2u);
  EXPECT_NEAR(file["margin"].get<double>(),
              file["views"][1]["value"].get<double>() - file["views"][0]["value"].get<double>(),
              1e-12);
  EXPECT_EQ(file["views"][0]["dials"]["ef"], 0.45);
  EXPECT_EQ(file["population"].size(), 1u);
  EXPECT_FALSE(file.contains("fit"));
  const std::string csv = bytesOf(folder / "1/views.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  for (const nlohmann::json& view : page["views"]) {
    ASSERT_EQ(view["outline"].size(), static_cast<std::size_t>(kFitFrames));
    for (const nlohmann::json& frame : view["outline"]) EXPECT_GT(frame.size(), 50u);
  }
  EXPECT_EQ(page["fit"]["map"].size(), static_cast<std::size_t>(kFitFrames));
  EXPECT_EQ(page["fit"]["curves"], file["curves_of_best"]);
}

TEST(CompareViewRanking, WhatCannotBeRankedIsRefusedInOneLine) {
  TempFolder folder;
  const std::string out = " -o '" + (folder / "out").string() + "'";
  for (const auto& [line, says] : std::initializer_list<std::pair<const char*, const char*>>{
           {"real --views a4c,a5c", "\"a5c\" is not a view (nearest: a"},
           {"real --views a4c", "two views or more"},
           {"real --views a4c,a2c,a4c", "a4c is given twice"},
           {"real --views all --scan ef=0.3:0.5:0.1", "give one of the two"},
           {"real --views all --view a2c", "--view and --yes: belong to --scan"},
           {"synthetic real --views all", "omit the synthetic one"},
           {"real --views all --scene scene.toml", "omit --scene"},
           {"real --scan ef=0.3:0.5:0.1 --scene scene.toml", "omit --scene"},
           {"real --views all --dials eff=0.5", "is not a dial"},
           {"real --views all --tilt 21", "tilt"},
           {"real", "with --scan or --views only the real one"},
           {"synthetic real --dials ef=0.5", "is accepted with --scan or --views only"},
           {"nowhere.avi --views all", "nowhere.avi"}}) {
    const Outcome outcome = runShell(std::string("%B compare ") + line + out);
    EXPECT_EQ(outcome.code, 2) << line << "\n" << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(says), std::string::npos) << line << "\n" << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out")) << line;
  }
}

}  // namespace
}  // namespace echocine::fit
