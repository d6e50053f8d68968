#include "live/live_page.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/cycle/loop_ecg.h"
#include "page/assets.h"
#include "page/page.h"
#include "scene/names.h"
#include "scene/scene_keys.h"
#include "scene/view_names.h"
#include "signal/picture.h"
#include "truth/aha_segments.h"
#include "view/view_json.h"

namespace echocine::live {

namespace {

using Json = nlohmann::ordered_json;

// Infinite ends of a range become null.
Json endOf(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

const char* kindName(KeyKind kind) {
  switch (kind) {
    case KeyKind::number:
      return "number";
    case KeyKind::whole:
      return "whole";
    case KeyKind::flag:
      return "flag";
    case KeyKind::word:
      return "word";
    case KeyKind::other:
      break;
  }
  return "other";
}

Json keysJson() {
  Json list = Json::array();
  for (const SceneKey& key : sceneKeys()) {
    if (!isLiveKey(key)) continue;
    Json words = Json::array();
    if (key.field.kind == KeyKind::word)
      for (const std::string_view word : key.field.words()) words.push_back(word);
    list.push_back({{"key", key.fullName()},
                    {"unit", key.unit.symbol},
                    {"kind", kindName(key.field.kind)},
                    {"lo", endOf(key.range.lo)},
                    {"hi", endOf(key.range.hi)},
                    {"words", words},
                    {"meaning", key.meaning}});
  }
  return list;
}

// In the file's unit, rounded to what a scene file would hold.
Json shownValue(const SceneKey& key, const KeyValue& value) {
  if (const auto* number = std::get_if<double>(&value)) {
    const double in_unit = key.unit.from_si(*number);
    if (!std::isfinite(in_unit) || in_unit == 0) return in_unit == 0 ? Json(0.0) : Json();
    const double digits = std::pow(10, 9 - std::ceil(std::log10(std::abs(in_unit))));
    return std::round(in_unit * digits) / digits;
  }
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return *whole;
  if (const auto* flag = std::get_if<bool>(&value)) return *flag;
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  return {};
}

Json viewsJson() {
  Json list = Json::array();
  for (const ViewName& view : viewNames())
    list.push_back({{"key", view.key}, {"meaning", view.meaning}});
  return list;
}

Json ecgJson(const CardiacClock& clock, double frame_rate_hz) {
  constexpr std::size_t kPoints = 512;  // as many as a page has columns for it
  const std::vector<double> lead = loopEcg(clock, frame_rate_hz);
  Json points = Json::array();
  for (std::size_t i = 0; i < kPoints; ++i)
    points.push_back(std::round(1e3 * lead[i * (lead.size() - 1) / (kPoints - 1)]) / 1e3);
  return points;
}

std::string titleOf(const std::filesystem::path& scene_file) {
  const std::filesystem::path file = std::filesystem::absolute(scene_file).lexically_normal();
  return (file.parent_path().filename() / file.filename()).string();
}

Json vectorOf(Vec3d v) {
  return {v.x, v.y, v.z};
}

}  // namespace

Json keyValues(const Scene& given) {
  Scene& scene = const_cast<Scene&>(given);  // fields give access for the reader, too
  Json values = Json::object();
  for (const SceneKey& key : sceneKeys())
    if (isLiveKey(key) && key.field.get != nullptr && key.applies({&scene}))
      values[key.fullName()] = shownValue(key, key.field.get({&scene}));
  return values;
}

Json sectorJson(const Scene& scene) {
  const Probe& probe = scene.probe;
  const PictureGeometry g = pictureGeometry(scene);
  Json sector = Json::array();
  for (const Vec3d p : scanAreaOutline(probe)) sector.push_back({1e3 * p.x, 1e3 * p.z});
  return {{"pose",
           {{"origin_mm", vectorOf(1e3 * probe.pose.origin)},
            {"lateral", vectorOf(probe.pose.x_axis)},
            {"elevation", vectorOf(probe.pose.y_axis)},
            {"depth", vectorOf(probe.pose.z_axis)}}},
          {"aperture_mm", millimetresFromMetres(probe.aperture_m)},
          {"lens_mm", millimetresFromMetres(probe.elevation_aperture_m)},
          {"sector_mm", sector},
          {"depth_mm", millimetresFromMetres(probe.max_depth_m)},
          {"picture",
           {{"width", scene.output.width},
            {"height", scene.output.height},
            {"origin_px", {g.origin_x_px, g.origin_y_px}},
            {"mm_per_px", millimetresFromMetres(g.metres_per_pixel)}}}};
}

Json loopJson(const Scene& scene) {
  const CardiacClock clock(scene);
  const double rate_hz = scene.acquisition.frame_rate_hz;
  return {
      {"frames", clock.frameCount()}, {"frame_rate_hz", rate_hz}, {"ecg", ecgJson(clock, rate_hz)}};
}

std::string pageOf(const Simulator& simulator, const SceneView& view, const LiveScene& live,
                   const HeartDials* dials) {
  const Scene& scene = simulator.scene();
  const PageLook look{"EchoCine live: " + titleOf(live.file()),
                      {pageAsset("page.css"), pageAsset("heart_view.css"), pageAsset("live.css")},
                      pageAsset("live.html"),
                      {pageAsset("three.min.js"), pageAsset("page.js"), pageAsset("heart_view.js"),
                       pageAsset("live_heart.js"), pageAsset("live_probe.js"),
                       pageAsset("live_dials.js"), pageAsset("live_over.js"),
                       pageAsset("live_model.js"), pageAsset("live_out.js"), pageAsset("live.js")}};
  return servedPage(look, {{"version", ECHOCINE_VERSION},
                           {"title", titleOf(live.file())},
                           {"file", live.file().filename().string()},
                           {"views", viewsJson()},
                           {"keys", keysJson()},
                           {"values", keyValues(scene)},
                           {"sector", sectorJson(scene)},
                           {"loop", loopJson(scene)},
                           {"heart", dials ? dials->json() : Json()},
                           {"segment_names", kAhaNames},
                           {"view", viewJson(view, scene)}});
}

}  // namespace echocine::live
