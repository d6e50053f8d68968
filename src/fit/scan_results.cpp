// Output files of a scan of dials.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "fit/dial_scan.h"
#include "fit/results_folder.h"
#include "page/page.h"
#include "video/cine_writer.h"

namespace echocine::fit {

namespace {

using Json = nlohmann::ordered_json;

Json axesJson(const DialScan& scan) {
  Json axes = Json::array();
  for (std::size_t a = 0; a < scan.options.axes.size(); ++a) {
    const ScanAxis& axis = scan.options.axes[a];
    Json json{{"dial", axis.range.key},
              {"values", axis.values()},
              {"best", scan.points[scan.best].values[a]}};
    json["minimum"] = scan.minimum.empty() ? Json() : Json(scan.minimum[a]);
    json["curvature_per_step2"] = scan.curvature.empty() ? Json() : Json(scan.curvature[a]);
    axes.push_back(json);
  }
  return axes;
}

Json scanJson(const DialScan& scan) {
  Json points = Json::array();
  for (const ScanPoint& p : scan.points) {
    points.push_back(foundJson(p.found));
    points.back()["values"] = p.values;
  }
  Json centre = foundJson(scan.centre);
  centre["confidence"] = scan.centre.confidence;
  centre["at_limit_of_search"] = scan.centre.at_limit;
  centre["rivals"] = Json::array();
  for (const auto& [pose, value] : scan.centre.rivals) {
    centre["rivals"].push_back(poseJson(pose));
    centre["rivals"].back()["discrepancy"] = value;
  }
  Json json{{"version", ECHOCINE_VERSION},
            {"real", scan.label},
            {"view", scan.view},
            {"dials", scan.options.dials},
            {"axes", axesJson(scan)},
            {"best", scan.best},
            {"caveats", scan.caveats},
            {"confounding", scan.confounding},
            {"beat", beatJson(scan.beat)},
            {"beat_anchor", scan.beat_anchor},
            {"centre", centre},
            {"cpu_ms", {{"recording_hearts", scan.family_ms}, {"evaluation", scan.evaluation_ms}}},
            {"points", points},
            {"curves_of_best", structureCurvesJson(scan.where)},
            {"segments_of_best", segmentCurvesJson(scan.where)},
            {"notes", scan.notes}};
  if (scan.tilt) json["tilt"] = tiltJson(*scan.tilt);
  return json;
}

// The page alone has the maps: they are its pictures.
void writeScanPage(const DialScan& scan, Json json, const std::filesystem::path& path) {
  PageWriter page(path, fitPageLook("EchoCine: dials against " + scan.label, "scan"));
  addFitPictures(scan.where, page);
  json["fit"] = fitJson(scan.where);
  page.finish(json);
}

std::string scanCsv(const DialScan& scan) {
  std::string text;
  for (const ScanAxis& axis : scan.options.axes) text += axis.range.key + ",";
  text +=
      "discrepancy,region,boundary,motion,overlap,shift_lateral_mm,shift_depth_mm,turn_deg,"
      "scale\n";
  for (const ScanPoint& p : scan.points) {
    for (const double value : p.values) text += fmt::format("{:.6g},", value);
    const PoseFound& f = p.found;
    text += fmt::format("{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},{:.3f},{:.3f},{:.3f},{:.5f}\n",
                        f.discrepancy, f.terms.region, f.terms.boundary, f.terms.motion,
                        f.terms.overlap, 1e3 * f.pose.shift_x_m, 1e3 * f.pose.shift_z_m,
                        degreesFromRadians(f.pose.turn_rad), f.pose.scale);
  }
  return text;
}

}  // namespace

void writeScan(const DialScan& scan, const std::filesystem::path& folder) {
  const ResultsFolder results(folder, {"scan.json", "scan.html"});
  const Json json = scanJson(scan);
  results.write("scan.csv", scanCsv(scan));
  writeScanPage(scan, json, folder / "scan.html");
  results.write("scan.json",
                json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace echocine::fit
