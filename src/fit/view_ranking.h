#pragma once
// The view of a heart that a loop shows, and its heart.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fit/fit_report.h"
#include "fit/heart_search.h"

namespace echocine::fit {

// "all", or at least two views such as "a4c,a2c,plax". Throws SceneError naming --views for an
// unknown view, a repeated view, or fewer than two.
std::vector<heart::View> parseViews(const std::string& text);

struct ViewsOptions {
  std::filesystem::path real;
  echo::SideOptions side;
  std::vector<heart::View> views;
  std::map<std::string, double> dials;  // fixed dials
  double tilt_deg = 0;                  // limit of tilt and rotation of the planes, either way
};

// A view, and its best heart.
struct ViewFound {
  heart::View view{};
  BeatFound beat;  // by this view's models, unless known otherwise
  HeartFound heart;
  FitReport where;  // of that heart
};

// Searches one view with its hearts. Throws like rankViews(). Precondition: the family has that
// view, the population's dials and that tilt.
ViewFound searchView(heart::View view, const HeartFamily& family,
                     const std::vector<ScanAxis>& population, const echo::EchoLoop& real,
                     const echo::SideOptions& side, double tilt_deg = 0,
                     const Monitor& monitor = {});

struct ViewRanking {
  ViewsOptions options;
  std::vector<ScanAxis> population;  // the searched dials
  std::vector<ViewFound> views;      // in ascending order of V
  std::string beat_anchor;           // of the loop: EchoLoop::beat_anchor
  // V of the second view minus V of the best; and Eq. 8 of descent.h, with the second
  // as rival and baseline 1.
  double margin = 0, confidence = 0;
  double nodes_ms = 0, cpu_ms = 0;   // CPU time: of computing hearts, of everything
  std::vector<std::string> caveats;  // caveats.h
  std::vector<std::string> notes;
  std::string label;  // of the loop: EchoLoop::label
};

// Throws SceneError and JobError like compareLoops(). Runs in parallel.
ViewRanking rankViews(const ViewsOptions& options, const Monitor& monitor = {});
// The same for a loop in memory; options.real is not used.
ViewRanking rankViews(const echo::EchoLoop& real, const ViewsOptions& options,
                      const Monitor& monitor = {});
// Sorts the views and sets margin and confidence. Precondition: at least two views.
void orderViews(ViewRanking& ranking);

// views.csv, views.json and views.html. Throws JobError.
void writeViews(const ViewRanking& ranking, const std::filesystem::path& folder);

}  // namespace echocine::fit
