#include "fit/fit_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "fit/caveats.h"
#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/probe_placement.h"
#include "page/assets.h"
#include "scene/probe_pose.h"
#include "truth/aha_segments.h"
#include "video/cine_writer.h"

namespace echocine::fit {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

// With the real frame nearest to each of the model's.
FitReport fitReport(const ModelLoop& model, const ModelDiscrepancy& discrepancy,
                    const echo::EchoLoop& real, const FitPose& pose) {
  FitReport out;
  out.map = discrepancy.map(model, pose);
  out.structures = model.structures;
  out.systole = model.systole;
  out.metres_per_pixel = discrepancy.stack().metresPerPixel();
  out.apex_x_px = real.sector().apex_x;
  out.apex_y_px = real.sector().apex_y;
  const echo::BeatSpan& beat = discrepancy.beat().span;
  const int last = real.video.frameCount() - 1;
  for (int n = 0; n < kFitFrames; ++n) {
    const double phase = echo::warpedPhase(static_cast<double>(n) / kFitFrames, model.systole,
                                           beat.systole),
                 at = beat.end_diastole + beat.frames * phase,
                 within = at > last + 0.5 ? at - beat.frames : at;
    const auto frame =
        static_cast<std::size_t>(std::clamp(static_cast<int>(std::lround(within)), 0, last));
    out.pictures.push_back({real.video.width, real.video.height, real.video.frames[frame]});
  }
  return out;
}

SceneFit fitScene(const Scene& scene, const echo::EchoLoop& real, const echo::SideOptions& side,
                  double tilt_deg, const Monitor& monitor) {
  const MeshMotion motion(scene);
  const auto segments = wallSegments(scene, motion);
  const ModelLoop model = modelLoop(scene, motion, kFitFrames, segments);
  const ModelDiscrepancy discrepancy(real, side, model);
  SceneFit fit;
  fit.beat = discrepancy.beat();
  fit.found = discrepancy.search(model);
  fit.caveats = caveatsOf(real, fit.beat, fit.found.confidence);
  if (!(tilt_deg > 0)) {
    fit.where = fitReport(model, discrepancy, real, fit.found.pose);
    return fit;
  }
  const TiltableModel tiltable(scene, motion, kFitFrames, segments);
  fit.tilt = searchTilt([&](const PlaneTilt& tilt) { return tiltable.at(tilt); }, discrepancy,
                        fit.found, tilt_deg, monitor);
  fit.found = fit.tilt->found;
  fit.caveats = caveatsOf(real, fit.beat, fit.found.confidence);
  fit.where = fitReport(tiltable.at(fit.tilt->tilt), discrepancy, real, fit.found.pose);
  Scene tilted = scene;
  tilted.probe.pose =
      turnedAndTilted(scene.probe.pose, fit.tilt->tilt.rotate_rad, fit.tilt->tilt.tilt_rad);
  fit.tilted_probe = poseToml(tilted);
  return fit;
}

Json poseJson(const FitPose& p) {
  return {{"shift_mm", {1e3 * p.shift_x_m, 1e3 * p.shift_z_m}},
          {"turn_deg", degreesFromRadians(p.turn_rad)},
          {"scale", p.scale}};
}

Json foundJson(const PoseFound& f) {
  return {{"discrepancy", f.discrepancy}, {"region", f.terms.region},
          {"boundary", f.terms.boundary}, {"motion", f.terms.motion},
          {"overlap", f.terms.overlap},   {"pose", poseJson(f.pose)}};
}

Json beatJson(const BeatFound& beat) {
  return {{"end_systole",
           {{"part_of_beat", beat.span.systole > 0 ? Json(beat.span.systole) : Json()},
            {"of_model", beat.span.systole > 0 ? Json(beat.span.shown_systole) : Json()},
            {"source", beat.systole_source},
            {"confidence", beat.systole_confidence}}},
          {"end_diastole_frame", beat.span.end_diastole},
          {"frames", beat.span.frames},
          {"length_source", beat.length_source},
          {"start_source", beat.start_source},
          {"confidence", beat.confidence}};
}

Json tiltJson(const TiltFound& t) {
  return {{"tilt_deg", degreesFromRadians(t.tilt.tilt_rad)},
          {"rotate_deg", degreesFromRadians(t.tilt.rotate_rad)},
          {"most_deg", t.most_deg},
          {"tilt_confidence", t.tilt_confidence},
          {"rotate_confidence", t.rotate_confidence},
          {"at_limit_of_search", t.at_limit},
          {"discrepancy", t.found.discrepancy},
          {"discrepancy_untilted", t.untilted},
          {"planes", t.planes}};
}

Json tiltJson(const SceneFit& fit) {
  Json json = tiltJson(*fit.tilt);
  json["probe_toml"] = fit.tilted_probe;
  return json;
}

namespace {

template <typename NameOf>
Json curvesJson(const std::vector<OffsetCurve>& all, const char* what, const NameOf& nameOf) {
  Json curves = Json::array();
  for (const OffsetCurve& c : all)
    curves.push_back({{what, nameOf(c.part)},
                      {"offset_mm", c.offset_mm},
                      {"distance_mm", c.distance_mm},
                      {"motion_mm", c.motion_mm}});
  return curves;
}

// Three digits are a thousandth of a pixel here, and keep the page short.
double rounded(double value) {
  return std::round(1e3 * value) / 1e3;
}

// Places in pixels of the pictures.
struct PixelAt {
  const FitReport& where;
  double x(double m) const { return rounded(where.apex_x_px + m / where.metres_per_pixel); }
  double y(double m) const { return rounded(where.apex_y_px + m / where.metres_per_pixel); }
};

// A row for each boundary point and cell.
Json mapJson(const FitReport& where) {
  const PixelAt at{where};
  Json frames = Json::array();
  for (std::size_t n = 0; n < where.map.boundary.size(); ++n) {
    Json boundary = Json::array(), region = Json::array();
    for (const BoundaryOffset& p : where.map.boundary[n])
      boundary.push_back({at.x(p.x_m), at.y(p.z_m), rounded(p.offset_mm), rounded(p.certainty),
                          rounded(p.motion_mm), p.surface, p.segment});
    for (const RegionLeft& r : where.map.region[n])
      region.push_back({at.x(r.x_m), at.y(r.z_m), rounded(r.left)});
    frames.push_back({{"boundary", boundary}, {"region", region}});
  }
  return frames;
}

}  // namespace

Json outlineJson(const FitReport& where) {
  const PixelAt at{where};
  Json frames = Json::array();
  for (const std::vector<BoundaryOffset>& points : where.map.boundary) {
    frames.push_back(Json::array());
    for (const BoundaryOffset& p : points) frames.back().push_back({at.x(p.x_m), at.y(p.z_m)});
  }
  return frames;
}

Json structureCurvesJson(const FitReport& where) {
  return curvesJson(offsetCurves(where.map, where.structures.size()), "structure",
                    [&](std::size_t s) { return where.structures[s]; });
}

Json segmentCurvesJson(const FitReport& where) {
  return curvesJson(segmentCurves(where.map), "segment",
                    [](std::size_t s) { return kAhaNames[s - 1]; });
}

PageLook fitPageLook(const std::string& title, const std::string& name) {
  PageLook look = pageLook(title, pageAsset(name + ".html"), pageAsset(name + ".js"));
  look.scripts.insert(look.scripts.end() - 1, pageAsset("fit_map.js"));
  return look;
}

void addFitPictures(const FitReport& where, PageWriter& page, std::string_view loop) {
  const OutputSettings settings;
  for (const GreyImage& picture : where.pictures)
    page.addFrame(loop, encodeCineFrame(picture, settings.codec, settings.jpeg_quality));
}

Json fitJson(const FitReport& where) {
  return {{"structures", where.structures},
          {"map", mapJson(where)},
          {"mm_per_pixel", 1e3 * where.metres_per_pixel},
          {"curves", structureCurvesJson(where)},
          {"segments", segmentCurvesJson(where)}};
}

}  // namespace echocine::fit
