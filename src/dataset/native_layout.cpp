// The program's own layout: ID/cine.avi, ID/truth.npz and ID/loop.json.

#include <fmt/format.h>

#include "core/digest.h"
#include "dataset/compressed.h"
#include "dataset/layout.h"
#include "dataset/record.h"
#include "output/function_json.h"
#include "scene/names.h"
#include "scene/scene_json.h"
#include "truth/plane_labels.h"

namespace echocine::dataset {

namespace {

using Arrays = std::vector<NamedArray>;

void addCurves(const LoopSample& loop, Arrays& arrays) {
  std::vector<float> time_s, phase, volume_ml, ecg(loop.ecg.begin(), loop.ecg.end());
  for (const LoopFrame& frame : loop.frames) {
    time_s.push_back(static_cast<float>(frame.time.time_s));
    phase.push_back(static_cast<float>(frame.time.phase));
    volume_ml.push_back(static_cast<float>(frame.lv_ml));
  }
  const std::size_t frames = loop.frames.size();
  arrays.push_back({"time_s", npyBytes(time_s, {frames})});
  arrays.push_back({"phase", npyBytes(phase, {frames})});
  arrays.push_back({"lv_volume_ml", npyBytes(volume_ml, {frames})});
  arrays.push_back({"ecg", npyBytes(ecg, {frames})});
}

// labels [T, H, W].
void addLabels(const LoopSample& loop, Arrays& arrays) {
  std::vector<std::uint8_t> all;
  for (const LoopFrame& frame : loop.frames)
    all.insert(all.end(), frame.labels.begin(), frame.labels.end());
  arrays.push_back(
      {"labels", npyBytes(all, {loop.frames.size(), static_cast<std::size_t>(loop.height()),
                                static_cast<std::size_t>(loop.width())})});
}

// For each role: contour_ROLE [P, 2] in pixels, contour by contour, contour_ROLE_starts [C, 2], the
// frame and the first point of each contour, and contour_ROLE_visible [P], 1 if the picture shows
// the border at the point.
void addContours(const LoopSample& loop, Arrays& arrays) {
  for (const Role role : kContourRoles) {
    std::vector<float> points;
    std::vector<std::int32_t> starts;
    std::vector<std::uint8_t> visible;
    for (std::size_t f = 0; f < loop.frames.size(); ++f)
      for (const Contour& contour : loop.frames[f].contours) {
        if (roleOf(loop.scene.structures[index(contour.surface)]) != role) continue;
        starts.insert(starts.end(),
                      {static_cast<std::int32_t>(f), static_cast<std::int32_t>(points.size() / 2)});
        for (const Vec3d p : contour.points_m) {
          const PixelPoint at = pixelOf(loop.geometry, p);
          points.insert(points.end(), {static_cast<float>(at.x), static_cast<float>(at.y)});
        }
        visible.insert(visible.end(), contour.visible.begin(), contour.visible.end());
      }
    const std::string name = fmt::format("contour_{}", nameOf(role));
    arrays.push_back({name, npyBytes(points, {points.size() / 2, 2})});
    arrays.push_back({name + "_starts", npyBytes(starts, {starts.size() / 2, 2})});
    arrays.push_back({name + "_visible", npyBytes(visible, {visible.size()})});
  }
}

// track_px [T, N, 2], track_out_of_plane_mm and track_visible [T, N], track_layer and
// track_segment [N].
void addTracks(const LoopSample& loop, Arrays& arrays) {
  const std::size_t frames = loop.frames.size(), points = loop.tracked.size();
  std::vector<float> px, away_mm;
  std::vector<std::uint8_t> visible, layers, segments;
  for (const LoopFrame& frame : loop.frames)
    for (const Vec3f p : frame.tracks_m) {
      const PixelPoint at = pixelOf(loop.geometry, toDouble(p));
      px.insert(px.end(), {static_cast<float>(at.x), static_cast<float>(at.y)});
      away_mm.push_back(1e3f * p.y);
      visible.push_back(isShown(loop, p));
    }
  for (const TruthMaker::Tracked& t : loop.tracked) {
    layers.push_back(t.layer);
    segments.push_back(t.segment);
  }
  arrays.push_back({"track_px", npyBytes(px, {frames, points, 2})});
  arrays.push_back({"track_out_of_plane_mm", npyBytes(away_mm, {frames, points})});
  arrays.push_back({"track_visible", npyBytes(visible, {frames, points})});
  arrays.push_back({"track_layer", npyBytes(layers, {points})});
  arrays.push_back({"track_segment", npyBytes(segments, {points})});
}

std::vector<std::byte> truthFile(const Spec& spec, const LoopSample& loop) {
  Arrays arrays;
  addCurves(loop, arrays);
  if (spec.wants("labels")) addLabels(loop, arrays);
  if (spec.wants("contours")) addContours(loop, arrays);
  if (!loop.tracked.empty()) addTracks(loop, arrays);
  return compressedNpz(arrays);
}

std::string loopText(const Heart& heart, const LoopSample& loop, const Json& numbers) {
  Json json = numbers;
  json["heart"] = heart.number;
  json["population"] = heart.population;
  json["split"] = nameOf(heart.split);
  std::vector<FunctionFrame> functions;
  for (const LoopFrame& frame : loop.frames)
    if (frame.function) functions.push_back(*frame.function);
  for (const auto& [name, values] : functionCurves(functions)) json["function"][name] = values;
  json["picture"] = {{"origin_x_px", loop.geometry.origin_x_px},
                     {"origin_y_px", loop.geometry.origin_y_px},
                     {"metres_per_pixel", loop.geometry.metres_per_pixel}};
  json["labels"] = {{"1", "lv_cavity"}, {"2", "lv_wall"}, {"3", "la"}};
  json["version"] = ECHOCINE_VERSION;
  json["scene"] = sceneJson(loop.scene);
  return json.dump(1) + "\n";
}

void writeNative(const Spec& spec, const Heart& heart, Sink& sink, Json& record) {
  for (std::size_t v = 0; v < heart.loops.size(); ++v) {
    const LoopSample& loop = heart.loops[v];
    std::vector<const GreyImage*> images;
    for (const LoopFrame& frame : loop.frames) images.push_back(&frame.image);
    const std::string folder = fmt::format("native/{}/", loop.id);
    sink.writeCine(folder + "cine.avi", images, loop.scene.acquisition.frame_rate_hz);
    sink.write(folder + "truth.npz", truthFile(spec, loop));
    sink.write(folder + "loop.json", loopText(heart, loop, record["loops"][v]));
  }
}

}  // namespace

const Layout kNative{"native", writeNative, nullptr};

}  // namespace echocine::dataset
