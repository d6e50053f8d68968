#include "compare/results.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/boundary_bands.h"
#include "compare/compare_page.h"
#include "compare/panels.h"
#include "core/error.h"
#include "core/file.h"
#include "core/shown_path.h"
#include "core/units.h"
#include "fit/fit_report.h"
#include "video/cine_writer.h"

namespace echocine::compare {

namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity: the PSNR of equal frames is null.
Json numberOrNull(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

// Where the trace lies in the picture, how fast it runs, and its R waves in frames.
Json ecgJson(const echo::EcgTrace& e, const FrameRate& rate) {
  return {{"kind", e.kind},
          {"box_px", {e.left, e.top, e.right, e.bottom}},
          {"px_per_frame", e.px_per_frame},
          {"px_per_s", rate.hz > 0 ? Json(e.px_per_frame * rate.hz) : Json()},
          {"r_wave_frames", e.r_frames},
          {"confidence", e.confidence}};
}

// The values used of each loop, each with its source, so that a reader can judge the
// result.
Json loopJson(const echo::EchoLoop& l, const echo::BeatLength& beat) {
  const echo::Sector& s = l.sector();
  Json json{{"label", l.label},
            {"format", l.video.format},
            {"grey_source", l.grey_source},
            {"width", l.video.width},
            {"height", l.video.height},
            {"frames", l.video.frames.size()},
            {"repeated_frames", l.video.repeats},
            {"frame_rate_hz", l.video.rate.hz > 0 ? Json(l.video.rate.hz) : Json()},
            {"frame_rate_source", l.video.rate.source},
            {"frame_rate_trusted", l.video.rate.trusted},
            {"mm_per_pixel", l.metres_per_pixel ? Json(1e3 * *l.metres_per_pixel) : Json()},
            {"scale_source", l.scale_source},
            {"sector",
             {{"apex_px", {s.apex_x, s.apex_y}},
              {"first_deg", degreesFromRadians(s.first_rad)},
              {"last_deg", degreesFromRadians(s.last_rad)},
              {"r_min_px", s.r_min},
              {"r_max_px", s.r_max},
              {"source", l.find.given ? "given" : "found"},
              {"confidence", l.find.confidence()},
              {"aspect_of_lower_edge", l.find.aspect}}},
            {"beat",
             {{"frames", beat.frames > 0 ? Json(beat.frames) : Json()},
              {"source", beat.source},
              {"confidence", beat.confidence},
              {"anchor", l.beat_anchor},
              {"ecg", l.ecg ? ecgJson(*l.ecg, l.video.rate) : Json()}}},
            {"notes", l.video.notes}};
  return json;
}

Json placementJson(const echo::Placement& p) {
  return {{"shift_px", {p.shift_x_px, p.shift_y_px}},
          {"scale", p.scale},
          {"rotation_deg", degreesFromRadians(p.rotation_rad)}};
}

Json spaceJson(const Comparison& c) {
  Json json = placementJson(c.space.placement);
  json["method"] = c.space.method;
  json["used"] = c.space.used;
  json["at_limit_of_search"] = c.space.at_limit;
  json["confidence"] = c.space.confidence;
  json["unlike"] = c.space.unlike;
  json["unlike_definition"] =
      "E = (1 - G) / c, minimal at the best placement: dissimilarity of edges without the bias of "
      "the overlap";
  json["rivals"] = Json::array();
  for (const PlacementFound& rival : c.space.rivals) {
    json["rivals"].push_back(placementJson(rival.placement));
    json["rivals"].back()["unlike"] = rival.unlike;
  }
  return json;
}

Json timeJson(const TimeAlignment& t) {
  return {{"method", t.method},
          {"shift_frames", t.shift_frames},
          {"synthetic_frames_per_real_frame", t.rate},
          {"largest_warp_frames", t.largest_warp_frames},
          {"correlation", t.correlation},
          {"confidence", t.confidence}};
}

// How the scene itself lies in the real loop, apart from its greys.
Json sceneFitJson(const fit::SceneFit& fit) {
  Json json = fit::foundJson(fit.found);
  json["confidence"] = fit.found.confidence;
  json["caveats"] = fit.caveats;
  json["beat"] = fit::beatJson(fit.beat);
  if (fit.tilt) json["tilt"] = fit::tiltJson(fit);
  json["curves"] = fit::structureCurvesJson(fit.where);
  json["segments"] = fit::segmentCurvesJson(fit.where);
  return json;
}

void addMetrics(std::string& row, const FrameMetrics& m, bool measured) {
  for (const Metric& metric : kMetrics)
    row += measured ? fmt::format(",{:.6g}", m.*metric.value) : ",";
}

// The cine and the frames of the page.
void writeFrames(const Comparison& c, const PanelMaker& panels, const std::filesystem::path& path,
                 ComparePage& page) {
  OutputSettings settings;
  settings.width = 3 * panels.width();
  settings.height = panels.height();
  // Players need some rate; one that is not known plays slowly enough to look.
  CineWriter writer(path, settings,
                    c.real.video.rate.hz > 0 ? std::min(c.real.video.rate.hz, 1e3) : 25);
  for (const FrameResult& f : c.frames) {
    std::vector<GreyImage> pictures;
    for (const Panel panel : {Panel::real, Panel::synthetic, Panel::difference}) {
      pictures.push_back(panels.picture(panel, f.real_frame));
      if (page.shows(f.real_frame))
        page.addFrame(panel,
                      encodeCineFrame(pictures.back(), settings.codec, settings.jpeg_quality));
    }
    writer.add(
        encodeCineFrame(PanelMaker::sideBySide(pictures), settings.codec, settings.jpeg_quality));
  }
  writer.finish();
}

}  // namespace

Json metricsJson(const FrameMetrics& m) {
  if (!(m.weight > 0)) {  // nothing was visible: a missing score differs from a score of 0
    Json none = Json::object();
    for (const Metric& metric : kMetrics) none[metric.key] = nullptr;
    return none;
  }
  Json json = Json::object();
  for (const Metric& metric : kMetrics) json[metric.key] = numberOrNull(m.*metric.value);
  return json;
}

Json summaryJson(const Comparison& c) {
  Json bands = Json::object();
  for (const BandMetrics& b : c.mean_bands) bands[b.structure] = metricsJson(b.metrics);
  std::size_t counted = 0;
  for (const FrameResult& f : c.frames) counted += f.counted() ? 1 : 0;
  return {{"version", ECHOCINE_VERSION},
          {"discrepancy", c.discrepancy},
          {"discrepancy_as_placed", c.discrepancy_as_placed},
          {"discrepancy_definition",
           "1 - c G, mean over counted frames; G: correlation of the gradients of both frames, "
           "smoothed by 2 % of the depth, 1 for equal edges and 0 for unrelated ones; c: overlap, "
           "the share of the common sector that both loops cover after registration"},
          {"overlap", c.overlap},
          {"frames_counted", counted},
          {"frames_total", c.frames.size()},
          {"before_calibration", metricsJson(c.mean_before)},
          {"after_calibration", metricsJson(c.mean_after)},
          {"bands_after_calibration", bands},
          {"calibration", {{"synthetic_grey", c.curve.knots}, {"real_grey", c.curve.values}}},
          {"time", timeJson(c.time)},
          {"space", spaceJson(c)},
          {"beam_space",
           {{"lines", c.grid.lines},
            {"samples", c.grid.samples},
            {"first_deg", degreesFromRadians(c.grid.first_rad)},
            {"last_deg", degreesFromRadians(c.grid.last_rad)},
            {"near", c.grid.near},
            {"far", c.grid.far},
            {"unit", c.grid.metric ? "m" : "outer radius"}}},
          {"synthetic", loopJson(c.synthetic, c.synthetic_beat)},
          {"real", loopJson(c.real, c.real_beat)},
          {"scene_fit", c.scene_fit ? sceneFitJson(*c.scene_fit) : Json()},
          {"notes", c.notes}};
}

// An empty cell is what was not measured, never 0.
std::string framesCsv(const Comparison& c) {
  std::string text =
      "real_frame,real_time_s,synthetic_frame,synthetic_phase,repeat,counted,discrepancy";
  std::vector<std::string> groups{"before", "after"};
  for (const BandMetrics& b : c.mean_bands) groups.push_back("band_" + b.structure);
  for (const std::string& group : groups)
    for (const Metric& metric : kMetrics) text += fmt::format(",{}_{}", metric.key, group);
  text += "\n";
  for (const FrameResult& f : c.frames) {
    const bool measured = f.synthetic_place >= 0;
    std::string row = fmt::format(
        "{},{:.6g},{},{},{},{},{}", f.real_frame, f.real_time_s,
        measured ? fmt::format("{:.6g}", f.synthetic_place) : "",
        f.synthetic_phase >= 0 ? fmt::format("{:.6g}", f.synthetic_phase) : "", f.repeat ? 1 : 0,
        f.counted() ? 1 : 0, measured ? fmt::format("{:.6g}", f.discrepancy) : "");
    addMetrics(row, f.before, measured);
    addMetrics(row, f.after, measured);
    for (std::size_t b = 0; b < c.mean_bands.size(); ++b)
      addMetrics(row, b < f.bands.size() ? f.bands[b].metrics : FrameMetrics{},
                 b < f.bands.size() && f.bands[b].metrics.weight > 0);
    text += row + "\n";
  }
  return text;
}

void writeResults(const Comparison& c, const CompareOptions& options,
                  const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder, error))
    throw JobError(fmt::format("{}: the folder cannot be created: {}", folder.string(),
                               error ? error.message() : "a file has this name"));
  for (const char* name : {"summary.json", "compare.html"})  // a folder without them is unfinished
    std::filesystem::remove(folder / name, error);
  for (const char* name : {"summary.json", "compare.html", "frames.csv", "side_by_side.avi",
                           "sector_real.png", "sector_synthetic.png"})
    removePartsOf(folder / name);  // of a run that was killed here
  PanelMaker panels(c);
  std::optional<BoundaryBands> bands;
  if (options.contours && !options.scene.empty()) {
    bands.emplace(options.scene, c.synthetic, c.grid, 1e-3 * options.band_mm);
    panels.drawContours(&*bands);
  }
  const auto text = [&](const char* name, const std::string& content) {
    writeFileWhole(folder / name, std::as_bytes(std::span(content)));
  };
  text("frames.csv", framesCsv(c));
  const std::vector<std::byte> real = encodePng(sectorPicture(c.real)),
                               synthetic = encodePng(sectorPicture(c.synthetic));
  writeFileWhole(folder / "sector_real.png", real);
  writeFileWhole(folder / "sector_synthetic.png", synthetic);
  // Last of all summary.json: a folder that has it is finished.
  ComparePage page(folder / "compare.html", c);
  writeFrames(c, panels, folder / "side_by_side.avi", page);
  Json summary = summaryJson(c);
  if (bands)  // whose lines the pictures have
    for (const BandMetrics& b : c.mean_bands)
      if (b.structure != "all") summary["contours"].push_back(b.structure);
  page.finish(summary, real, synthetic);
  text("summary.json",
       summary.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace echocine::compare
