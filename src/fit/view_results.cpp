// Output files of a ranking of views.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/units.h"
#include "fit/results_folder.h"
#include "fit/view_ranking.h"
#include "page/page.h"

namespace echocine::fit {

namespace {

using Json = nlohmann::ordered_json;

Json viewJson(const ViewFound& v, const ViewRanking& ranking) {
  Json dials = Json::object(), rivals = Json::array();
  for (const auto& [key, value] : ranking.options.dials) dials[key] = value;
  for (std::size_t a = 0; a < v.heart.values.size(); ++a)
    dials[ranking.population[a].range.key] = v.heart.values[a];
  for (const auto& [pose, value] : v.heart.found.rivals) {
    rivals.push_back(poseJson(pose));
    rivals.back()["discrepancy"] = value;
  }
  Json json{{"view", keyOf(v.view)},
            {"value", v.heart.left},
            {"coverage", v.heart.coverage},
            {"dials", dials}};
  json.update(foundJson(v.heart.found));
  json["pose_confidence"] = v.heart.found.confidence;
  json["at_limit_of_search"] = v.heart.found.at_limit;
  json["rivals"] = rivals;
  json["discrepancy_of_middle_heart"] = v.heart.middle;
  json["hearts"] = v.heart.hearts;
  json["beat"] = beatJson(v.beat);
  if (v.heart.tilt) json["tilt"] = tiltJson(*v.heart.tilt);
  return json;
}

Json viewsJson(const ViewRanking& ranking) {
  Json views = Json::array(), population = Json::array();
  for (const ViewFound& v : ranking.views) views.push_back(viewJson(v, ranking));
  for (const ScanAxis& d : ranking.population)
    population.push_back({{"dial", d.range.key}, {"low", d.range.low}, {"high", d.range.high}});
  return {{"version", ECHOCINE_VERSION},
          {"real", ranking.label},
          {"best", keyOf(ranking.views.front().view)},
          {"margin", ranking.margin},
          {"confidence", ranking.confidence},
          {"caveats", ranking.caveats},
          {"population", population},
          {"dials", ranking.options.dials},
          {"beat_anchor", ranking.beat_anchor},
          {"cpu_ms", {{"recording_hearts", ranking.nodes_ms}, {"all", ranking.cpu_ms}}},
          {"views", views},
          {"curves_of_best", structureCurvesJson(ranking.views.front().where)},
          {"notes", ranking.notes}};
}

// The page alone has outlines and maps: they are its pictures.
void writeViewsPage(const ViewRanking& ranking, Json json, const std::filesystem::path& path) {
  PageWriter page(path, fitPageLook("EchoCine: views against " + ranking.label, "views"));
  for (std::size_t i = 0; i < ranking.views.size(); ++i) {
    const ViewFound& v = ranking.views[i];
    addFitPictures(v.where, page, keyOf(v.view));
    json["views"][i]["outline"] = outlineJson(v.where);
  }
  addFitPictures(ranking.views.front().where, page);
  json["fit"] = fitJson(ranking.views.front().where);
  page.finish(json);
}

std::string viewsCsv(const ViewRanking& ranking) {
  std::string text = "view,value,coverage,discrepancy,region,boundary,motion,overlap,";
  for (const ScanAxis& d : ranking.population) text += d.range.key + ",";
  text +=
      "shift_lateral_mm,shift_depth_mm,turn_deg,scale,pose_confidence,tilt_deg,"
      "rotate_deg\n";
  for (const ViewFound& v : ranking.views) {
    const PoseFound& f = v.heart.found;
    text += fmt::format("{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},", keyOf(v.view),
                        v.heart.left, v.heart.coverage, f.discrepancy, f.terms.region,
                        f.terms.boundary, f.terms.motion, f.terms.overlap);
    for (const double value : v.heart.values) text += fmt::format("{:.6g},", value);
    const PlaneTilt tilt = v.heart.tilt ? v.heart.tilt->tilt : PlaneTilt{};
    text += fmt::format("{:.3f},{:.3f},{:.3f},{:.5f},{:.4f},{:.3f},{:.3f}\n",
                        1e3 * f.pose.shift_x_m, 1e3 * f.pose.shift_z_m,
                        degreesFromRadians(f.pose.turn_rad), f.pose.scale, f.confidence,
                        degreesFromRadians(tilt.tilt_rad), degreesFromRadians(tilt.rotate_rad));
  }
  return text;
}

}  // namespace

void writeViews(const ViewRanking& ranking, const std::filesystem::path& folder) {
  const ResultsFolder results(folder, {"views.json", "views.html"});
  const Json json = viewsJson(ranking);
  results.write("views.csv", viewsCsv(ranking));
  writeViewsPage(ranking, json, folder / "views.html");
  results.write("views.json",
                json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace echocine::fit
