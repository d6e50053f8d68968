#pragma once
// Which view of a heart a loop shows, and what heart.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fit/fit_report.h"
#include "fit/heart_search.h"

namespace echocine::fit {

// "all", or two or more of them, such as "a4c,a2c,plax". Throws SceneError naming --views: no view,
// one twice, fewer than two.
std::vector<heart::View> parseViews(const std::string& text);

struct ViewsOptions {
  std::filesystem::path real;
  echo::SideOptions side;
  std::vector<heart::View> views;
  std::map<std::string, double> dials;  // that stay
  double tilt_deg = 0;                  // by which planes may be tilted and rotated, either way
};

// A view, and the heart that fits best in it.
struct ViewFound {
  heart::View view{};
  BeatFound beat;  // as this view's models tell it, where nothing else does
  HeartFound heart;
  FitReport where;  // of that heart
};

// One view by its hearts. Throws as rankViews() does. Precondition: the family is of that view, of
// the population's dials, and made for that tilt.
ViewFound searchView(heart::View view, const HeartFamily& family,
                     const std::vector<ScanAxis>& population, const echo::EchoLoop& real,
                     const echo::SideOptions& side, double tilt_deg = 0,
                     const Monitor& monitor = {});

struct ViewRanking {
  ViewsOptions options;
  std::vector<ScanAxis> population;  // the dials that were sought
  std::vector<ViewFound> views;      // the least V first
  std::string beat_anchor;           // of the loop: EchoLoop::beat_anchor
  // Of the first: V of the second less its own; and Eq. 8 of descent.h, where the second is the
  // rival and 1 the value of what says nothing.
  double margin = 0, confidence = 0;
  double nodes_ms = 0, cpu_ms = 0;  // CPU time: of recording hearts, of all
  std::vector<std::string> notes;
};

// Throws SceneError and JobError as compareLoops() does. Runs in parallel.
ViewRanking rankViews(const ViewsOptions& options, const Monitor& monitor = {});
// Of a loop in memory; options.real plays no part.
ViewRanking rankViews(const echo::EchoLoop& real, const ViewsOptions& options,
                      const Monitor& monitor = {});
// Orders the views, and tells margin and confidence. Precondition: two or more.
void orderViews(ViewRanking& ranking);

// views.csv, views.json and views.html. Throws JobError.
void writeViews(const ViewRanking& ranking, const std::filesystem::path& folder);

}  // namespace echocine::fit
