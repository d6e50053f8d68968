// view_table [HEART [VIEW|all [TILT]]]: which of eight views of a model lies nearest to a loop of
// each view, with its margin. The models are the same heart, a healthy one, and then a population
// of hearts whose dials are found; at last their planes are tilted by up to TILT degrees. One line
// for each loop and kind of models, by the discrepancy D and by V of coverage.h.

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>

#include "core/parallel.h"
#include "fit/coverage.h"
#include "fit/view_ranking.h"
#include "support/moving_statics.h"

namespace echocine::bench {
namespace {

using namespace echo;
using namespace fit;
using namespace support;

std::vector<ModelLoop> modelsOf(const std::function<Scene(View)>& sceneFor) {
  std::vector<ModelLoop> models;
  for (const ViewName& name : viewNames()) {
    const Scene scene = sceneFor(name.view);
    models.push_back(modelLoop(scene, MeshMotion(scene), kFitFrames));
  }
  return models;
}

// Of one loop in a view.
struct Nearness {
  PoseFound found;
  double coverage = 0;
  std::string dials;
  double left() const { return pictureDiscrepancy(found.discrepancy, coverage); }
};

// Of all eight, right ones and margins.
struct Score {
  int right = 0, views = 0;
  double least = 2, sum = 0;
  void add(double margin) {
    ++views;
    right += margin > 0 ? 1 : 0;
    least = std::min(least, margin);
    sum += margin;
  }
  std::string text() const {
    return fmt::format("{} of {}, margin {:.3f} in the mean, {:.3f} at least", right, views,
                       sum / std::max(1, views), least);
  }
};
struct Scores {
  Score by_d, by_v;
};

template <typename Value>
double marginOf(const std::vector<Nearness>& all, std::size_t right, const Value& value,
                std::size_t& next) {
  next = right == 0 ? 1 : 0;
  for (std::size_t v = 0; v < all.size(); ++v)
    if (v != right && value(all[v]) < value(all[next])) next = v;
  return value(all[next]) - value(all[right]);
}

void judge(const std::string& what, const std::vector<Nearness>& all, std::size_t right,
           Scores& scores) {
  std::size_t next_d, next_v;
  const double by_d = marginOf(
                   all, right, [](const Nearness&n) { return n.found.discrepancy; }, next_d),
               by_v = marginOf(
                   all, right, [](const Nearness&n) { return n.left(); }, next_v);
  scores.by_d.add(by_d);
  scores.by_v.add(by_v);
  const auto tell = [&](std::size_t v) {
    const Nearness& n = all[v];
    const FitTerms& t = n.found.terms;
    const FitPose& p = n.found.pose;
    return fmt::format(
        "{} V {:.3f} a {:.2f} D {:.3f} (R {:.2f} B {:.2f} M {:.2f} c {:.2f}; {:.0f},{:.0f} mm "
        "{:.0f} deg{})",
        viewNames()[v].key, n.left(), n.coverage, n.found.discrepancy, t.region, t.boundary,
        t.motion, t.overlap, 1e3 * p.shift_x_m, 1e3 * p.shift_z_m, p.turn_rad * 57.3, n.dials);
  };
  fmt::print("  {:<32} V {:+.3f} D {:+.3f}  {}  next {}{}\n", what, by_v, by_d, tell(right),
             tell(next_v), next_d == next_v ? "" : "; by D " + tell(next_d));
  std::fflush(stdout);
}

constexpr NamedHeart kHearts[] = {
    {"parametric", [](View view) { return sceneOf(Family::shipped, view); }},
    {"patient", [](View view) { return sceneOf(Family::patient, view); }},
    {"whole heart", [](View view) { return sceneOf(Family::whole, view); }},
    {"patient with atria", &wholePatientScene},
    {"four chambers", &movingFourChambersScene},
    {"template", &movingTemplateScene}};

struct Case {
  const NamedHeart* heart;
  std::size_t view;
  EchoLoop loop;
  std::string name() const { return fmt::format("{} {}", heart->name, viewNames()[view].key); }
};

SideOptions fromFirstFrame() {
  SideOptions side;
  side.ed_frame = 0;
  return side;
}

std::vector<Case> casesOf(const char* heart_only, const char* view_only) {
  std::vector<Case> cases;
  for (const NamedHeart& heart : kHearts) {
    if (heart_only != nullptr && std::strcmp(heart_only, heart.name) != 0) continue;
    for (std::size_t v = 0; v < viewNames().size(); ++v)
      if (view_only == nullptr || std::strcmp(view_only, "all") == 0 ||
          std::strcmp(view_only, viewNames()[v].key) == 0)
        cases.push_back(
            {&heart, v, scannedLoop(heart.in(viewNames()[v].view), 24, 11 + static_cast<int>(v))});
  }
  return cases;
}

void judgeModels(const char* what, const std::vector<ModelLoop>& models, const Case& c,
                 std::map<std::string, Scores>& scores) {
  const ModelDiscrepancy discrepancy(c.loop, fromFirstFrame(), models[c.view]);
  std::vector<Nearness> all;
  for (const ModelLoop& model : models) {
    const PoseFound found = discrepancy.search(model);
    all.push_back({found, coverageOf(model, discrepancy.stack(), found.pose), ""});
  }
  judge(c.name() + ", " + what, all, c.view, scores[std::string(c.heart->name) + ", " + what]);
}

void judgePopulation(const std::vector<Case>& cases, double tilt_deg,
                     std::map<std::string, Scores>& scores) {
  const std::vector<ScanAxis> population = populationWithout({});
  std::vector<DialRange> ranges;
  for (const ScanAxis& axis : population) ranges.push_back(axis.range);
  const HeartNodes hearts({}, ranges, kFitFrames, 4);
  std::vector<std::vector<Nearness>> all(cases.size());
  for (const ViewName& name : viewNames()) {
    const HeartFamily family(hearts, name.view, {}, tilt_deg);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const HeartFound h =
          searchView(name.view, family, population, cases[i].loop, fromFirstFrame(), tilt_deg)
              .heart;
      all[i].push_back(
          {h.found, h.coverage, fmt::format(", EF {:.2f}, {:.0f} mL", h.values[0], h.values[1])});
      if (h.tilt)
        all[i].back().dials += fmt::format(", tilt {:.0f},{:.0f} deg", h.tilt->tilt.tilt_rad * 57.3,
                                           h.tilt->tilt.rotate_rad * 57.3);
    }
  }
  const std::string what = tilt_deg > 0 ? "a population, tilted" : "a population";
  for (std::size_t i = 0; i < cases.size(); ++i)
    judge(cases[i].name() + ", " + what, all[i], cases[i].view,
          scores[std::string(cases[i].heart->name) + ", " + what]);
}

void run(const char* heart_only, const char* view_only, double tilt_deg) {
  const std::vector<Case> cases = casesOf(heart_only, view_only);
  std::map<std::string, Scores> scores;
  if (tilt_deg > 0) {
    judgePopulation(cases, tilt_deg, scores);
  } else {
    const std::vector<ModelLoop> healthy =
        modelsOf([](View view) { return heart::heartScene(heart::parametersFrom({}), view, 20); });
    std::map<const NamedHeart*, std::vector<ModelLoop>> same;
    for (const Case& c : cases) {
      if (!same.contains(c.heart)) same[c.heart] = modelsOf(c.heart->in);
      judgeModels("the same heart", same[c.heart], c, scores);
      judgeModels("a healthy heart", healthy, c, scores);
    }
    judgePopulation(cases, 0, scores);
  }
  for (const auto& [what, s] : scores)
    fmt::print("{}: right view first by V in {}; by D in {}\n", what, s.by_v.text(), s.by_d.text());
}

}  // namespace
}  // namespace echocine::bench

int main(int argc, char** argv) {
  const auto given = [&](int i) { return argc > i ? argv[i] : nullptr; };
  echocine::withThreads(
      0, [&] { echocine::bench::run(given(1), given(2), argc > 3 ? std::atof(argv[3]) : 0); });
}
