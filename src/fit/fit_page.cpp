#include "fit/fit_page.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "fit/fit_results.h"
#include "frame/simulator.h"
#include "motion/heart/heart_cycle.h"
#include "motion/heart/heart_scene.h"
#include "motion/surfaces/probe_placement.h"
#include "page/assets.h"
#include "view/view_json.h"

namespace echocine::fit {

namespace {

using Json = nlohmann::ordered_json;

PageLook lookOf(const HeartFit& fit) {
  PageLook look = fitPageLook(fit.views.size() == 1 ? "EchoCine: a heart fitted to a loop"
                                                    : "EchoCine: a heart fitted to loops",
                              "fit");
  look.styles.push_back(pageAsset("heart_view.css"));
  const std::vector<std::string_view> drawing = heartViewScripts();
  look.scripts.insert(look.scripts.end() - 1, drawing.begin(), drawing.end());
  return look;
}

// The heart with the sector of the first view.
Json heartJson(const HeartFit& fit) {
  const ViewFitted& first = fit.views.front();
  Scene scene =
      heart::heartScene(heart::parametersFrom(fit.dials), first.view, kFitFrames, Look::clean);
  scene.probe.pose = turnedAndTilted(scene.probe.pose, first.tilt.rotate_rad, first.tilt.tilt_rad);
  const Simulator simulator(scene);
  return viewJson(viewScene(simulator), simulator.scene());
}

Json overlayJson(const ViewFitted& view) {
  FitReport report = view.report;
  if (view.own) report.map = beyondOwn(std::move(report.map), *view.own);
  Json json = fitJson(report);
  json["outline"] = outlineJson(report);
  json["beyond_own"] = view.own.has_value();
  return json;
}

}  // namespace

FitMap beyondOwn(FitMap map, const FitReport& own) {
  const std::vector<OffsetCurve> curves = offsetCurves(own.map, own.structures.size());
  for (std::size_t n = 0; n < map.boundary.size(); ++n)
    for (BoundaryOffset& point : map.boundary[n])
      for (const OffsetCurve& curve : curves)
        if (curve.part == point.surface && n < curve.offset_mm.size() &&
            std::isfinite(curve.offset_mm[n]))
          point.offset_mm -= static_cast<float>(curve.offset_mm[n]);
  return map;
}

void writeFitPage(const HeartFit& fit, const std::vector<std::string>& labels,
                  const std::filesystem::path& path) {
  Json json = fitJson(fit, labels);
  if (fit.ef) json["volume"] = volumeJson(fit);
  json["heart"] = heartJson(fit);
  PageWriter page(path, lookOf(fit));
  for (std::size_t v = 0; v < fit.views.size(); ++v) {
    const ViewFitted& view = fit.views[v];
    const std::string name = keyOf(view.view);
    addFitPictures(view.report, page, name);
    if (view.own) addFitPictures(*view.own, page, name + " twin");
    json["views"][v]["overlay"] = overlayJson(view);
  }
  page.finish(json);
}

}  // namespace echocine::fit
