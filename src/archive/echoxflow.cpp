#include "archive/echoxflow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/error.h"
#include "core/file.h"
#include "core/folder_lock.h"
#include "core/output_check.h"
#include "core/stop.h"
#include "scene/scan_geometry.h"
#include "scene/view_names.h"
#include "zarr/zarr_store.h"

namespace echocine {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kCatalogue = "croissant.json";
constexpr std::size_t kMostCatalogue = std::size_t{256} << 20;
constexpr double kLeastLimit_m_s = 0.01;  // of a loop that stands still

void refuseName(const char* option, const std::string& name) {
  const bool plain = !name.empty() && name.size() <= 100 &&
                     std::all_of(name.begin(), name.end(), [](unsigned char c) {
                       return std::isalnum(c) != 0 || c == '-' || c == '_';
                     });
  if (!plain)
    throw SceneError(fmt::format("{}: \"{}\", accepted: up to 100 letters, digits, \"-\" and \"_\"",
                                 option, name));
}

void refuseProbe(const Probe& probe) {
  if (probe.kind != ProbeKind::phased)
    throw SceneError("EchoXFlow stores sectors of phased probes; use the layout zea");
}

// Readers accept finite numbers only: 0 where no motion is defined.
std::vector<float> finiteOf(const std::vector<float>& values) {
  std::vector<float> out = values;
  for (float& v : out)
    if (!std::isfinite(v)) v = 0;
  return out;
}

// The role of an apical view in names of arrays; empty for other views.
std::string roleOf(const std::optional<View>& view) {
  if (view == View::a2c) return "2ch";
  if (view == View::a3c) return "3ch";
  if (view == View::a4c) return "4ch";
  return "";
}

// First and last line, and the centres of the first and last sample: the reader's grid is linear
// between them.
Json geometryOf(const BeamLoop& loop) {
  const ScanGeometry geometry(loop.scene.probe);
  return {{"depth_start_m", geometry.sampleDepth(0)},
          {"depth_end_m", geometry.sampleDepth(loop.samples - 1)},
          {"angle_start_rad", geometry.firstPlace()},
          {"angle_end_rad", geometry.lastPlace()},
          {"grid_size", {loop.samples, loop.lines}}};
}

Json sectorOf(const BeamLoop& loop, const char* semantic_id, const std::string& array) {
  return {{"semantic_id", semantic_id},
          {"frames", {{"array_path", "data/" + array}, {"format", "zarr_array"}}},
          {"timestamps", {{"array_path", "timestamps/" + array}}},
          {"geometry", geometryOf(loop)}};
}

Json manifestOf(const BeamLoop& loop, double limit_m_s, const std::string& role) {
  Json doppler = sectorOf(loop, "tissue_doppler", "tissue_doppler");
  doppler["velocity_limit_mps"] = limit_m_s;
  doppler["velocity_limit_source"] = "largest velocity of the loop";
  Json manifest{{"manifest_type", role.empty() ? "2d" : "2d+strain"},
                {"sectors", {sectorOf(loop, "bmode", "2d_brightness_mode"), doppler}}};
  if (loop.view) manifest["view_code"] = keyOf(*loop.view);
  if (role.empty()) return manifest;
  manifest["linked_panels"] =
      Json::array({{{"role_id", role},
                    {"view_code", keyOf(*loop.view)},
                    {"linked_recording",
                     {{"frames_array_path", "data/2d_brightness_mode"},
                      {"timestamps_array_path", "timestamps/2d_brightness_mode"}}}}});
  manifest["annotations"] = Json::array();
  for (const auto& [field, array] :
       {std::pair("contour_points", "_contour"), std::pair("strain_curve", "_curve")})
    manifest["annotations"].push_back(
        {{"target", {{"type", "linked_panel"}, {"semantic_id", role}, {"field", field}}},
         {"value", {{"array_path", "data/" + role + array}}},
         {"time", {{"array_path", "timestamps/" + role + array}}}});
  return manifest;
}

double medianStep(const std::vector<float>& times_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times_s.size(); ++i)
    steps.push_back(static_cast<double>(times_s[i]) - static_cast<double>(times_s[i - 1]));
  if (steps.empty()) return 0;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                   steps.end());
  return steps[steps.size() / 2];
}

Json rowOf(const std::vector<ZarrArray>& arrays, const std::string& exam,
           const std::string& recording, double frame_s) {
  Json row{{"recordings/exam_id", exam},
           {"recordings/recording_id", recording},
           {"recordings/zarr_path", exam + "/" + recording + ".zarr"},
           {"recordings/modes", {"2d", "tissue_doppler"}},
           {"recordings/content_types", Json::array()},
           {"recordings/array_paths", Json::array()},
           {"recordings/frame_counts_by_content_type", Json::object()},
           {"recordings/median_delta_time_by_content_type", Json::object()},
           {"recordings/stitch_beat_count", 1}};
  for (const ZarrArray& array : arrays) {
    row["recordings/array_paths"].push_back(array.path);
    if (!array.path.starts_with("data/")) continue;
    const std::string type = array.path.substr(5);
    row["recordings/content_types"].push_back(type);
    row["recordings/frame_counts_by_content_type"][type] = array.shape.front();
    row["recordings/median_delta_time_by_content_type"][type] =
        type == "ecg" ? 1 / kEcgRate_hz : frame_s;
  }
  return row;
}

// The catalogue in the file, or one without recordings.
Json catalogueIn(const fs::path& file) {
  std::error_code absent;
  if (!fs::exists(file, absent))
    return {{"@type", "sc:Dataset"}, {"name", "EchoCine"}, {"recordSet", Json::array()}};
  Json catalogue = Json::parse(readTextFile(file, kMostCatalogue), nullptr, false);
  if (!catalogue.is_object() || !catalogue.contains("recordSet") ||
      !catalogue["recordSet"].is_array())
    throw SceneError(fmt::format("{}: is not a catalogue of recordings", file.string()));
  return catalogue;
}

bool hasText(const Json& object, const char* key, const std::string& text) {
  return object.is_object() && object.contains(key) && object[key] == text;
}

// The catalogue with the row in place of an earlier one.
Json catalogueWith(const Json& row, Json catalogue) {
  Json* records = nullptr;
  for (Json& set : catalogue["recordSet"])
    if (hasText(set, "@id", "recordings")) records = &set;
  if (records == nullptr) {
    catalogue["recordSet"].push_back({{"@id", "recordings"}, {"data", Json::array()}});
    records = &catalogue["recordSet"].back();
  }
  Json rows = Json::array();
  if (records->contains("data") && (*records)["data"].is_array())
    for (const Json& other : (*records)["data"])
      if (!hasText(other, "recordings/zarr_path", row["recordings/zarr_path"]))
        rows.push_back(other);
  rows.push_back(row);
  (*records)["data"] = rows;
  return catalogue;
}

// A complete store takes the name at once. An earlier one is moved aside before and removed last,
// so that a run that is killed here loses neither.
void place(const fs::path& part, const fs::path& store, const fs::path& earlier) {
  std::error_code failed, absent;
  if (fs::exists(store, absent)) fs::rename(store, earlier, failed);
  if (!failed) fs::rename(part, store, failed);
  if (failed) {
    std::error_code ignored;
    if (!fs::exists(store, absent)) fs::rename(earlier, store, ignored);
    throw JobError(fmt::format("{}: cannot be written: {}", store.string(), failed.message()));
  }
  syncFolderOf(store);
  fs::remove_all(earlier, absent);
}

// The earlier store of a run that was killed while it replaced it.
void restore(const fs::path& store, const fs::path& earlier) {
  std::error_code failed;
  if (!fs::exists(earlier, failed)) return;
  if (fs::exists(store, failed)) {
    fs::remove_all(earlier, failed);
    return;
  }
  fs::rename(earlier, store, failed);
  if (failed)
    throw JobError(fmt::format("{}: cannot be restored: {}", store.string(), failed.message()));
}

}  // namespace

void checkEchoXFlow(const Scene& scene, const fs::path& root, const std::string& exam,
                    const std::string& recording) {
  if (!exam.empty()) refuseName("--exam", exam);
  if (!recording.empty()) refuseName("--recording", recording);
  refuseProbe(scene.probe);
  checkOutputFolder(root, {kCatalogue});
  catalogueIn(root / kCatalogue);
}

void writeEchoXFlow(const BeamLoop& loop, const fs::path& root, const std::string& exam,
                    const std::string& recording) {
  refuseName("--exam", exam);
  refuseName("--recording", recording);
  refuseProbe(loop.scene.probe);
  const auto t = static_cast<std::size_t>(loop.frames), z = static_cast<std::size_t>(loop.samples),
             x = static_cast<std::size_t>(loop.lines);
  const std::vector<std::uint8_t> greys = bytesOfGreys(loop);
  const std::vector<float> velocities = finiteOf(loop.beam_m_s);
  std::vector<float> ecg_s;
  for (std::size_t i = 0; i < loop.ecg.size(); ++i)
    ecg_s.push_back(static_cast<float>(static_cast<double>(i) / kEcgRate_hz - kEcgMargin_s));
  std::vector<ZarrArray> arrays{{"data/2d_brightness_mode", {t, z, x}, greys},
                                {"data/tissue_doppler", {t, z, x}, velocities},
                                {"data/ecg", {loop.ecg.size()}, loop.ecg},
                                {"timestamps/2d_brightness_mode", {t}, loop.times_s},
                                {"timestamps/tissue_doppler", {t}, loop.times_s},
                                {"timestamps/ecg", {ecg_s.size()}, ecg_s}};
  // A plane without muscle beside the cavity has no strain.
  const bool annotated =
      !loop.contour_m.empty() && std::all_of(loop.strain_percent.begin(), loop.strain_percent.end(),
                                             [](float percent) { return std::isfinite(percent); });
  const std::string role = annotated ? roleOf(loop.view) : "";
  if (!role.empty()) {
    arrays.push_back({"data/" + role + "_contour", {t, kContourPoints, 2}, loop.contour_m});
    arrays.push_back({"data/" + role + "_curve", {t}, loop.strain_percent});
    for (const char* name : {"_contour", "_curve"})
      arrays.push_back({"timestamps/" + role + name, {t}, loop.times_s});
  }
  double limit = kLeastLimit_m_s;
  for (const float v : velocities) limit = std::max(limit, std::abs(static_cast<double>(v)));

  makeFolder(root);
  const FolderLock lock(root);
  const Json catalogue = catalogueIn(root / kCatalogue);
  makeFolder(root / exam);
  const fs::path store = root / exam / (recording + ".zarr"),
                 part = root / exam / ("." + recording + ".zarr.part"),
                 earlier = root / exam / ("." + recording + ".zarr.earlier");
  std::error_code ignored;
  fs::remove_all(part, ignored);
  restore(store, earlier);
  writeZarr(part, {{"recording_manifest", manifestOf(loop, limit, role)}}, arrays);
  unstoppable([&] {
    syncAllOf(part);
    const Json row = rowOf(arrays, exam, recording, medianStep(loop.times_s));
    const std::string text = catalogueWith(row, catalogue).dump(1);
    place(part, store, earlier);
    writeFileWhole(root / kCatalogue, std::as_bytes(std::span(text)));
  });
}

}  // namespace echocine
