// What a scan of dials leaves in its folder.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/dial_scan.h"
#include "core/error.h"
#include "core/file.h"
#include "core/shown_path.h"
#include "core/units.h"
#include "page/assets.h"
#include "page/page.h"
#include "video/cine_writer.h"

namespace echocine::compare {

namespace {

using Json = nlohmann::ordered_json;

Json poseJson(const FitPose& p) {
  return {{"shift_mm", {1e3 * p.shift_x_m, 1e3 * p.shift_z_m}},
          {"turn_deg", degreesFromRadians(p.turn_rad)},
          {"scale", p.scale}};
}

Json foundJson(const PoseFound& f) {
  return {{"discrepancy", f.discrepancy}, {"region", f.terms.region},
          {"boundary", f.terms.boundary}, {"motion", f.terms.motion},
          {"in_sight", f.terms.in_sight}, {"pose", poseJson(f.pose)}};
}

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

// Three digits are a thousandth of a pixel here, and keep the page short.
double rounded(double value) {
  return std::round(1e3 * value) / 1e3;
}

Json curvesJson(const ScanMap& where) {
  Json curves = Json::array();
  for (const OffsetCurve& c : offsetCurves(where.map, where.structures.size()))
    curves.push_back({{"structure", where.structures[c.structure]},
                      {"offset_mm", c.offset_mm},
                      {"distance_mm", c.distance_mm},
                      {"motion_mm", c.motion_mm}});
  return curves;
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
  return {{"version", ECHOCINE_VERSION},
          {"real", shownName(scan.options.real.string())},
          {"view", scan.view},
          {"dials", scan.options.dials},
          {"axes", axesJson(scan)},
          {"best", scan.best},
          {"confounding", scan.confounding},
          {"beat",
           {{"end_diastole_frame", scan.beat.span.end_diastole},
            {"frames", scan.beat.span.frames},
            {"length_source", scan.beat.length_source},
            {"start_source", scan.beat.start_source},
            {"confidence", scan.beat.confidence}}},
          {"centre", centre},
          {"cpu_ms", {{"recording_hearts", scan.family_ms}, {"evaluation", scan.evaluation_ms}}},
          {"points", points},
          {"curves_of_best", curvesJson(scan.where)},
          {"notes", scan.notes}};
}

// Places in pixels of the pictures; a row for each boundary point and cell.
Json mapJson(const ScanMap& where) {
  const auto x = [&](double m) { return rounded(where.apex_x_px + m / where.metres_per_pixel); };
  const auto y = [&](double m) { return rounded(where.apex_y_px + m / where.metres_per_pixel); };
  Json frames = Json::array();
  for (std::size_t n = 0; n < where.map.boundary.size(); ++n) {
    Json boundary = Json::array(), region = Json::array();
    for (const BoundaryOffset& p : where.map.boundary[n])
      boundary.push_back({x(p.x_m), y(p.z_m), rounded(p.offset_mm), rounded(p.certainty),
                          rounded(p.motion_mm), p.surface});
    for (const RegionLeft& r : where.map.region[n])
      region.push_back({x(r.x_m), y(r.z_m), rounded(r.left)});
    frames.push_back({{"boundary", boundary}, {"region", region}});
  }
  return frames;
}

// The page alone has the maps: they are its pictures.
void writeScanPage(const DialScan& scan, Json json, const std::filesystem::path& path) {
  PageWriter page(path, pageLook("EchoCine: dials against " + shownName(scan.options.real.string()),
                                 pageAsset("scan.html"), pageAsset("scan.js")));
  const OutputSettings settings;
  for (const GreyImage& picture : scan.where.pictures)
    page.addFrame("real", encodeCineFrame(picture, settings.codec, settings.jpeg_quality));
  json["structures"] = scan.where.structures;
  json["map"] = mapJson(scan.where);
  json["mm_per_pixel"] = 1e3 * scan.where.metres_per_pixel;
  page.finish(json);
}

std::string scanCsv(const DialScan& scan) {
  std::string text;
  for (const ScanAxis& axis : scan.options.axes) text += axis.range.key + ",";
  text +=
      "discrepancy,region,boundary,motion,in_sight,shift_lateral_mm,shift_depth_mm,turn_deg,"
      "scale\n";
  for (const ScanPoint& p : scan.points) {
    for (const double value : p.values) text += fmt::format("{:.6g},", value);
    const PoseFound& f = p.found;
    text += fmt::format("{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},{:.3f},{:.3f},{:.3f},{:.5f}\n",
                        f.discrepancy, f.terms.region, f.terms.boundary, f.terms.motion,
                        f.terms.in_sight, 1e3 * f.pose.shift_x_m, 1e3 * f.pose.shift_z_m,
                        degreesFromRadians(f.pose.turn_rad), f.pose.scale);
  }
  return text;
}

}  // namespace

void writeScan(const DialScan& scan, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder, error))
    throw JobError(fmt::format("{}: the folder cannot be made: {}", folder.string(),
                               error ? error.message() : "a file stands there"));
  for (const char* name : {"scan.json", "scan.html"})  // a folder without them is unfinished
    std::filesystem::remove(folder / name, error);
  const auto text = [&](const char* name, const std::string& content) {
    writeFileWhole(folder / name, std::as_bytes(std::span(content)));
  };
  const Json json = scanJson(scan);
  text("scan.csv", scanCsv(scan));
  writeScanPage(scan, json, folder / "scan.html");
  text("scan.json", json.dump(1) + "\n");
}

}  // namespace echocine::compare
