#include "output/truth_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "output/npy.h"
#include "scene/names.h"
#include "truth/sector_clip.h"
#include "video/cine_writer.h"

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

// Colours that differ between neighbours: hues by the golden angle, black for 0. Our choice.
std::vector<PaletteColour> palette() {
  std::vector<PaletteColour> colours(256);
  for (std::size_t i = 1; i < colours.size(); ++i) {
    const double hue = std::fmod(static_cast<double>(i) * 0.618034, 1.0) * 6;
    const auto channel = [&](double shift) {
      const double d = std::abs(std::fmod(hue + shift, 6.0) - 3) - 1;
      return static_cast<std::uint8_t>(60 + 180 * std::clamp(d, 0.0, 1.0));
    };
    colours[i] = {channel(0), channel(4), channel(2)};
  }
  return colours;
}

// [x, z] pairs in the unit that `scale` makes of metres, to a micrometre or a thousandth pixel.
template <typename Place>
Json pointsJson(const std::vector<Vec3d>& points_m, const Place& place) {
  const auto rounded = [](double v) { return std::round(v * 1e3) / 1e3; };
  Json list = Json::array();
  for (const Vec3d p : points_m) {
    const std::pair<double, double> at = place(p);
    list.push_back({rounded(at.first), rounded(at.second)});
  }
  return list;
}

std::span<const std::byte> bytesOf(const std::string& text) {
  return std::as_bytes(std::span(text));
}

}  // namespace

std::vector<std::byte> colouredLabels(const Scene& scene, const FrameTruth& truth) {
  static const std::vector<PaletteColour> kColours = palette();
  if (!scene.truth.labels) return {};
  return encodePng(GreyImage{scene.output.width, scene.output.height, truth.labels}, kColours);
}

TruthFiles::TruthFiles(std::filesystem::path folder, const Scene& scene, const LabelTable& labels)
    : folder_(std::move(folder)),
      scene_(scene),
      labels_(labels),
      geometry_(pictureGeometry(scene)),
      outline_(sectorOutline(scene.probe)) {
  if (!scene.truth.any()) return;
  std::error_code failed;
  std::filesystem::create_directories(folder_, failed);
  if (failed)
    throw JobError(
        fmt::format("{}: the folder cannot be created: {}", folder_.string(), failed.message()));
}

std::string TruthFiles::put(const std::string& name, std::span<const std::byte> bytes) const {
  writeFileWhole(folder_ / name, bytes);
  return sha256Hex(bytes);
}

std::vector<std::byte> TruthFiles::labelPicture(const FrameTruth& truth) const {
  return encodePng(GreyImage{scene_.output.width, scene_.output.height, truth.labels});
}

// Places in the imaging plane: x lateral and z depth in mm from the apex, and in the picture's
// pixels. `in_sector`: the part that the sector shows, closed where its edges cut.
std::string TruthFiles::contoursText(const FrameRecord& record, const FrameTruth& truth) const {
  const auto mm = [](Vec3d p) { return std::pair(1e3 * p.x, 1e3 * p.z); };
  const auto px = [&](Vec3d p) {
    const PixelPoint at = pixelOf(geometry_, p);
    return std::pair(at.x, at.y);
  };
  Json list = Json::array();
  for (const Contour& contour : truth.contours) {
    const Structure& structure = scene_.structures[index(contour.surface)];
    Json entry{{"structure", structure.name},
               {"role", nameOf(roleOf(structure))},
               {"closed", contour.closed},
               {"points_mm", pointsJson(contour.points_m, mm)},
               {"points_px", pointsJson(contour.points_m, px)}};
    if (!contour.visible.empty())
      entry["visible"] = std::vector<int>(contour.visible.begin(), contour.visible.end());
    if (contour.closed) {
      const std::vector<Vec3d> shown = clipped(contour.points_m, outline_);
      entry["in_sector_mm"] = pointsJson(shown, mm);
      entry["in_sector_px"] = pointsJson(shown, px);
    }
    list.push_back(std::move(entry));
  }
  const Json json{{"index", record.frame},
                  {"time_s", record.time_s},
                  {"phase", record.phase},
                  {"contours", list}};
  return json.dump() + "\n";
}

std::map<std::string, std::string> TruthFiles::write(const FrameRecord& record,
                                                     const FrameTruth& truth,
                                                     std::vector<PendingFile>& pending) const {
  std::map<std::string, std::string> files;
  const auto prepare = [&](const std::string& name, std::span<const std::byte> bytes) {
    files["truth/" + name] = sha256Hex(bytes);
    pending.emplace_back(folder_ / name, bytes);
  };
  if (scene_.truth.labels)
    prepare(fmt::format("labels_{:04}.png", record.frame), labelPicture(truth));
  if (scene_.truth.contours)
    prepare(fmt::format("contours_{:04}.json", record.frame), bytesOf(contoursText(record, truth)));
  return files;
}

void TruthFiles::add(const FrameRecord& record, const FrameTruth& truth) {
  records_.push_back(record);
  if (truth.function) functions_.push_back(*truth.function);
  for (const Vec3f p : truth.tracks_m) {
    const PixelPoint at = pixelOf(geometry_, toDouble(p));
    tracks_mm_.insert(tracks_mm_.end(), {1e3f * p.x, 1e3f * p.y, 1e3f * p.z});
    tracks_px_.insert(tracks_px_.end(), {static_cast<float>(at.x), static_cast<float>(at.y)});
    out_of_plane_mm_.push_back(1e3f * p.y);
    tracks_visible_.push_back(
        inScanArea(scene_.probe, static_cast<double>(p.x), static_cast<double>(p.z)));
  }
}

// T frames, N points: places_mm [T, N, 3] (lateral, elevation, depth), places_px [T, N, 2],
// out_of_plane_mm [T, N], visible [T, N], layer [N], segment [N], time_s [T].
std::vector<std::byte> TruthFiles::tracksFile(std::span<const TruthMaker::Tracked> tracked) const {
  const std::size_t frames = records_.size(), points = tracked.size();
  std::vector<std::uint8_t> layers, segments;
  std::vector<float> times_s;
  for (const TruthMaker::Tracked& t : tracked) {
    layers.push_back(t.layer);
    segments.push_back(t.segment);
  }
  for (const FrameRecord& r : records_) times_s.push_back(static_cast<float>(r.time_s));
  const NamedArray arrays[] = {{"places_mm", npyBytes(tracks_mm_, {frames, points, 3})},
                               {"places_px", npyBytes(tracks_px_, {frames, points, 2})},
                               {"out_of_plane_mm", npyBytes(out_of_plane_mm_, {frames, points})},
                               {"visible", npyBytes(tracks_visible_, {frames, points})},
                               {"layer", npyBytes(layers, {points})},
                               {"segment", npyBytes(segments, {points})},
                               {"time_s", npyBytes(times_s, {frames})}};
  return npzBytes(arrays);
}

std::map<std::string, std::string> TruthFiles::finish(const LoopTruth& loop) const {
  std::map<std::string, std::string> files;
  if (scene_.truth.tracks) files["truth/tracks.npz"] = put("tracks.npz", tracksFile(loop.tracked));
  if (scene_.truth.function) {
    const Json json = functionJson(records_, functions_, loop, geometry_);
    files["truth/function.json"] = put("function.json", bytesOf(json.dump(1) + "\n"));
  }
  return files;
}

std::map<std::string, std::string> TruthFiles::writeTables() const {
  std::map<std::string, std::string> files;
  if (!scene_.truth.labels) return files;
  Json names = Json::object(), structures = Json::array();
  for (const LabelTable::Entry& entry : labels_.entries)
    names[std::to_string(entry.number)] = entry.name;
  for (std::size_t s = 0; s < scene_.structures.size(); ++s)
    structures.push_back({{"name", scene_.structures[s].name},
                          {"role", nameOf(roleOf(scene_.structures[s]))},
                          {"structure_id", s + 1},
                          {"label", labels_.numbers[s]}});
  const Json json{
      {"0", "background, or outside the sector"}, {"labels", names}, {"structures", structures}};
  files["truth/labels.json"] = put("labels.json", bytesOf(json.dump(1) + "\n"));
  return files;
}

}  // namespace echocine
