#include "render/report.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <nlohmann/json.hpp>

#include "motion/cycle/ecg.h"
#include "page/assets.h"
#include "scene/scene_json.h"
#include "signal/picture.h"
#include "view/view_json.h"

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

// The lead over the frames' time, fine enough for a QRS complex to keep its shape.
Json ecgJson(const CardiacClock& clock, double from_s, double to_s) {
  constexpr double kPointRate_hz = 400;
  constexpr int kMostPoints = 20000;
  const int points = std::clamp(static_cast<int>((to_s - from_s) * kPointRate_hz), 2, kMostPoints);
  Json times = Json::array(), lead = Json::array();
  for (int i = 0; i < points; ++i) {
    const double time_s = from_s + (to_s - from_s) * i / (points - 1);
    const FrameTime time = clock.atTime(time_s);
    times.push_back(time_s);
    lead.push_back(ecgAmplitude(time.time_in_beat_s, time.beat_s));
  }
  return {{"time_s", times}, {"lead", lead}};
}

// "beating_heart/scene.toml": most scene files are called the same.
std::string titleOf(const Scene& scene) {
  const std::filesystem::path file = std::filesystem::absolute(scene.file).lexically_normal();
  return (file.parent_path().filename() / file.filename()).string();
}

// The main properties of a structure; the rest is in the manifest.
Json structuresJson(const Scene& scene) {
  Json list = Json::array();
  for (const Structure& s : scene.structures)
    list.push_back({{"name", s.name},
                    {"medium", scene.medium(s.medium).name},
                    {"membrane", s.membrane},
                    {"keyframes", s.keyframes.size()}});
  return list;
}

// One array per quantity over the frames that are shown.
Json framesJson(const Manifest& manifest, const ReportPage& page) {
  Json frames{{"index", Json::array()},
              {"time_s", Json::array()},
              {"phase", Json::array()},
              {"beat", Json::array()},
              {"volumes_ml", Json::object()}};
  for (const FrameEntry& entry : manifest.frames) {
    if (!page.shows(entry.record.frame)) continue;
    frames["index"].push_back(entry.record.frame);
    frames["time_s"].push_back(entry.record.time_s);
    frames["phase"].push_back(entry.record.phase);
    frames["beat"].push_back(entry.record.beat);
    for (const auto& [name, ml] : entry.volumes_ml) frames["volumes_ml"][name].push_back(ml);
  }
  return frames;
}

// Numbers to a tenth of a pixel take a third of the page's bytes.
Json tenths(const std::vector<float>& values) {
  Json list = Json::array();
  for (const float v : values) list.push_back(std::round(10 * static_cast<double>(v)) / 10);
  return list;
}

Json outlinesJson(const std::vector<PageTruth>& frames) {
  Json list = Json::array();
  for (const PageTruth& frame : frames) {
    Json of_frame = Json::array();
    for (const PageTruth::Outline& o : frame.outlines)
      of_frame.push_back({o.structure, o.closed, tenths(o.px)});
    list.push_back(std::move(of_frame));
  }
  return list;
}

// Values of the frames that the page shows.
Json curvesJson(const Manifest& manifest, const ReportPage& page) {
  Json curves = Json::object();
  for (const auto& [name, values] : manifest.curves) {
    Json shown = Json::array();
    for (std::size_t i = 0; i < values.size(); ++i)
      if (page.shows(manifest.frames[i].record.frame)) shown.push_back(values[i]);
    curves[name] = std::move(shown);
  }
  return curves;
}

// Values that differ from run to run are separate, last on the page.
Json measuredJson(const Manifest& manifest) {
  Json timings = stageTimesJson(manifest), shares = Json::object();
  timings["wall"] = manifest.wall_ms;
  for (const Json& effect : effectsJson(manifest))
    shares[effect["name"].get<std::string>()] = effect["time_share"];
  return {{"timings_ms_per_frame", timings}, {"time_shares", shares}};
}

}  // namespace

namespace {

std::vector<PageTruth::Outline> outlinesOf(const FrameTruth& truth, const Scene& scene,
                                           const PictureGeometry& picture) {
  constexpr float kApart_px = 1.5f, kBeyond_px = 50;  // our choices
  const auto width = static_cast<float>(scene.output.width),
             height = static_cast<float>(scene.output.height);
  std::vector<PageTruth::Outline> outlines;
  for (const Contour& contour : truth.contours) {
    PageTruth::Outline outline{index(contour.surface), contour.closed, {}};
    bool seen = false;
    for (const Vec3d p : contour.points_m) {
      const PixelPoint at = pixelOf(picture, p);
      const auto x = static_cast<float>(at.x), y = static_cast<float>(at.y);
      seen |=
          x > -kBeyond_px && y > -kBeyond_px && x < width + kBeyond_px && y < height + kBeyond_px;
      const std::size_t n = outline.px.size();
      if (n == 0 || std::hypot(x - outline.px[n - 2], y - outline.px[n - 1]) > kApart_px)
        outline.px.insert(outline.px.end(), {x, y});
    }
    if (seen) outlines.push_back(std::move(outline));
  }
  return outlines;
}

}  // namespace

PageTruth pageTruth(const FrameTruth& truth, const Scene& scene, std::vector<std::byte> labels) {
  constexpr std::size_t kMostPoints = 300;  // enough to see the motion by
  const PictureGeometry picture = pictureGeometry(scene);
  PageTruth page{outlinesOf(truth, scene, picture), {}, std::move(labels)};
  const std::size_t every = truth.tracks_m.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < truth.tracks_m.size(); i += every) {
    const PixelPoint at = pixelOf(picture, toDouble(truth.tracks_m[i]));
    page.tracks_px.insert(page.tracks_px.end(),
                          {static_cast<float>(at.x), static_cast<float>(at.y)});
  }
  return page;
}

ReportPage::ReportPage(const std::filesystem::path& path, const Scene& scene,
                       const CardiacClock& clock, std::pair<int, int> range)
    : scene_(scene), clock_(clock), range_(range), stride_(pageStride(range.second - range.first)) {
  if (!scene.output.report) return;
  PageLook look =
      pageLook("EchoCine: " + titleOf(scene), pageAsset("report.html"), pageAsset("report.js"));
  look.styles.push_back(pageAsset("heart_view.css"));
  const std::vector<std::string_view> drawing = heartViewScripts();
  look.scripts.insert(look.scripts.end() - 1, drawing.begin(), drawing.end());
  writer_.emplace(path, look);
}

ReportPage::~ReportPage() = default;

bool ReportPage::shows(int frame) const {
  return writer_ && (frame - range_.first) % stride_ == 0;
}

void ReportPage::addFrame(std::span<const std::byte> image) {
  if (writer_) writer_->addFrame("cine", image);
}

void ReportPage::addTruth(PageTruth truth) {
  if (!writer_) return;
  if (!truth.labels.empty()) writer_->addFrame("labels", truth.labels);
  truth.labels = {};
  truths_.push_back(std::move(truth));
}

void ReportPage::prepareView(const Simulator& simulator) {
  if (!writer_) return;
  try {
    view_ = std::make_unique<const Json>(viewJson(viewScene(simulator), scene_));
  } catch (const std::exception&) {
  }
}

void ReportPage::finish(const Manifest& manifest, const Simulator& simulator) {
  if (!writer_) return;
  // The page gets the manifest's own JSON, so that both say the same.
  const Json scene = sceneJson(scene_);
  const double rate_hz = scene_.acquisition.frame_rate_hz;
  Json effects = effectsJson(manifest);
  // Shares of time differ from run to run, and go to the page's end.
  for (Json& effect : effects) effect.erase("time_share");
  Json data{{"version", ECHOCINE_VERSION},
            {"title", titleOf(scene_)},
            {"scene_sha256", manifest.scene_sha256},
            {"loop_frames", manifest.loop_frames},
            {"frames_done", manifest.frames.size()},
            {"stride", stride_},
            {"frames", framesJson(manifest, *this)},
            {"ecg", ecgJson(clock_, range_.first / rate_hz, range_.second / rate_hz)},
            {"reference_intensity", manifest.reference_intensity},
            {"effects", effects},
            {"plan", planJson(manifest.plan)},
            {"warnings", manifest.warnings},
            {"media", mediaJson(scene_)},
            {"background", scene["background"]},
            {"structures", structuresJson(scene_)}};
  for (const char* part : {"probe", "acquisition", "motion", "signal", "accuracy", "output"})
    data[part] = scene[part];
  if (!truths_.empty()) {
    Json tracks = Json::array();
    for (const PageTruth& t : truths_) tracks.push_back(tenths(t.tracks_px));
    data["truth"] = {{"outlines", outlinesJson(truths_)},
                     {"tracks_px", tracks},
                     {"curves", curvesJson(manifest, *this)}};
  }
  data["view"] = view_ ? *view_ : viewJson(viewScene(simulator), scene_);
  data["measured"] = measuredJson(manifest);
  writer_->finish(data);
}

}  // namespace echocine
