#include "live/live_truth.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "live/live_renderer.h"
#include "motion/cycle/cardiac_clock.h"

namespace echocine::live {

namespace {

using Json = nlohmann::ordered_json;

// Our choice: points of three layers, about 2 mm apart along the wall.
constexpr int kTracks = 240;

double rounded(double value, double step) {
  return std::round(value / step) * step;
}

Json percent(double strain) {
  return std::isfinite(strain) ? Json(rounded(100 * strain, 0.01)) : Json();
}

// Two coordinates in the imaging plane, mm.
template <typename V>
Json inPlane(V p_m) {
  return {rounded(1e3 * p_m.x, 0.01), rounded(1e3 * p_m.z, 0.01)};
}

Json contoursJson(const std::vector<Contour>& contours) {
  Json list = Json::array();
  for (const Contour& contour : contours) {
    Json points = Json::array();
    for (const Vec3d p : contour.points_m) points.push_back(inPlane(p));
    list.push_back(
        {{"structure", index(contour.surface)}, {"closed", contour.closed}, {"points_mm", points}});
  }
  return list;
}

Json tracksJson(const LiveTruth::Layers& layers) {
  Json list = Json::array();
  const auto& tracked = layers.maker->tracked();
  for (std::size_t i = 0; i < tracked.size() && i < layers.truth.tracks_m.size(); ++i)
    list.push_back({{"layer", tracked[i].layer},
                    {"segment", tracked[i].segment},
                    {"at_mm", inPlane(layers.truth.tracks_m[i])},
                    {"from_mm", inPlane(layers.first_tracks_m.at(i))}});
  return list;
}

Json functionJson(const FunctionFrame& f) {
  Json strain = Json::array();
  for (std::size_t s = 0; s < kAhaSegments; ++s)
    strain.push_back({{"name", kAhaNames[s]},
                      {"longitudinal", percent(f.segments[s].longitudinal)},
                      {"radial", percent(f.segments[s].radial)},
                      {"circumferential", percent(f.segments[s].circumferential)}});
  return {{"volume_ml", rounded(f.volume_ml, 0.01)},
          {"biplane_ml", rounded(f.biplane_ml, 0.01)},
          {"single_plane_ml", f.single_plane_ml ? Json(rounded(*f.single_plane_ml, 0.01)) : Json()},
          {"gls", percent(f.global_longitudinal_strain)},
          {"segments", strain}};
}

Json viewJson(const ViewOffset& view) {
  return {{"label", view.label},
          {"tilt_deg", rounded(view.tilt_deg, 0.01)},
          {"rotation_deg", view.rotation_deg ? Json(rounded(*view.rotation_deg, 0.01)) : Json()},
          {"shift_mm", rounded(view.shift_mm, 0.01)},
          {"foreshortening_mm",
           view.foreshortening_mm ? Json(rounded(*view.foreshortening_mm, 0.01)) : Json()}};
}

// The picture's scene with truth, without what truth does not depend on.
Scene withTruth(const Simulator& still, bool wall) {
  Scene scene = still.scene();
  scene.speckle.on = false;
  scene.artefacts.persistence = 0;
  scene.truth.labels = scene.truth.contours = true;
  scene.truth.tracks = scene.truth.function = wall;
  scene.truth.track_count = kTracks;
  return scene;
}

}  // namespace

void LiveTruth::prepare(const Simulator& still, const std::string& name, bool wall) {
  if (simulator_ && name_ == name && (wall_ || !wall)) return;
  simulator_.reset();
  name_.clear();
  wall_ = false;
  no_wall_.clear();
  first_tracks_m_.clear();
  const auto make = [&](bool with_wall) {
    simulator_ =
        std::make_unique<const Simulator>(withTruth(still, with_wall), still.sharedMotion());
    simulator_->truth();
  };
  try {
    make(wall);
    if (wall) {
      const FrameTime first = simulator_->cardiacClock().at(0);
      first_tracks_m_ = simulator_->truthAt(first).tracks_m;
    }
  } catch (const SceneError& error) {
    if (!wall) throw;
    no_wall_ = error.what();
    make(false);
  }
  name_ = name;
  wall_ = wall;
}

LiveTruth::Layers LiveTruth::at(const Simulator& still, const std::string& name, int frame,
                                bool wall) {
  const CardiacClock& clock = still.cardiacClock();
  if (frame < 0 || frame >= clock.frameCount())
    throw SceneError(fmt::format("frame: is {}, accepted: 0 to {}", frame, clock.frameCount() - 1));
  prepare(still, name, wall);
  return {simulator_->truthAt(clock.at(frame)), first_tracks_m_, simulator_->truth(), no_wall_};
}

std::string LiveTruth::bytes(const Layers& layers, const Scene& scene, int frame, bool labels) {
  Json head{{"frame", frame}, {"contours", contoursJson(layers.truth.contours)}};
  if (labels) {
    head["width"] = scene.output.width;
    head["height"] = scene.output.height;
  }
  if (!layers.no_wall.empty()) head["no_wall"] = layers.no_wall;
  if (layers.truth.function) {
    head["tracks"] = tracksJson(layers);
    head["function"] = functionJson(*layers.truth.function);
    if (const auto& view = layers.maker->view()) head["view"] = viewJson(*view);
  }
  const std::string json = head.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(json.size() >> (8 * i) & 0xFF);
  bytes += json;
  if (labels)
    for (const std::uint16_t id : layers.truth.picture_ids) {
      bytes += static_cast<char>(id & 0xFF);
      bytes += static_cast<char>(id >> 8);
    }
  return bytes;
}

}  // namespace echocine::live
