// EchoXFlow (github.com/Ahus-AIM/EchoXFlow, commit b782e0a4): B-mode of a recording with geometry
// and ECG.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "echo/beam_recording.h"
#include "zarr/zarr_input.h"

namespace echocine::echo {

namespace {

using Manifest = nlohmann::json;

constexpr char kUsualFrames[] = "data/2d_brightness_mode",
               kUsualTimes[] = "timestamps/2d_brightness_mode";

class ManifestReader {
 public:
  explicit ManifestReader(std::string name) : name_(std::move(name)) {}

  const Manifest& member(const Manifest& object, const char* key) const {
    if (!object.is_object() || !object.contains(key))
      throw SceneError(fmt::format("{}: recording_manifest: {} is absent", name_, key));
    return object[key];
  }
  double number(const Manifest& object, const char* key) const {
    const Manifest& value = member(object, key);
    if (!value.is_number())
      throw SceneError(fmt::format("{}: recording_manifest: {} is no number", name_, key));
    return value.get<double>();
  }
  std::string text(const Manifest& object, const char* key) const {
    const Manifest& value = member(object, key);
    if (!value.is_string())
      throw SceneError(fmt::format("{}: recording_manifest: {} is no text", name_, key));
    return value.get<std::string>();
  }

  // The path of an array of a sector; `usual` if the sector names none.
  std::string pathOf(const Manifest& sector, const char* role, const std::string& usual) const {
    if (!sector.is_object() || !sector.contains(role) || !sector[role].is_object() ||
        !sector[role].contains("array_path"))
      return usual;
    return text(sector[role], "array_path");
  }

  // The sector of that name, or the one with the usual array.
  const Manifest& bmode(const Manifest& attributes) const {
    const Manifest& sectors = member(member(attributes, "recording_manifest"), "sectors");
    if (sectors.is_array()) {
      for (const Manifest& sector : sectors)
        if (sector.is_object() && sector.value("semantic_id", Manifest()) == "bmode") return sector;
      for (const Manifest& sector : sectors)
        if (pathOf(sector, "frames", "") == kUsualFrames) return sector;
    }
    throw SceneError(fmt::format("{}: recording_manifest: has no sector \"bmode\"", name_));
  }

 private:
  std::string name_;
};

void takeEcgOf(const ZarrInput& store, BeamRecording& r) {
  if (!store.has("data/ecg") || !store.has("timestamps/ecg")) return;
  r.ecg = store.numbers("data/ecg", kMostEcgSamples).values;
  r.ecg_s = store.numbers("timestamps/ecg", kMostEcgSamples).values;
}

}  // namespace

BeamRecording readEchoXFlow(const std::filesystem::path& folder) {
  const ZarrInput store(folder);
  BeamRecording r;
  r.name = folder.string();
  r.format = "EchoXFlow";
  const ManifestReader manifest(r.name);
  const Manifest& sector = manifest.bmode(store.attributes());
  const Manifest& geometry = manifest.member(sector, "geometry");
  r.first_depth_m = manifest.number(geometry, "depth_start_m");
  r.last_depth_m = manifest.number(geometry, "depth_end_m");
  r.first_rad = manifest.number(geometry, "angle_start_rad");
  r.last_rad = manifest.number(geometry, "angle_end_rad");
  const std::string frames = manifest.pathOf(sector, "frames", kUsualFrames);
  const ZarrLayout layout = store.layout(frames);
  if (layout.shape.size() != 3)
    throw SceneError(fmt::format("{}: {}: has {} axes, accepted: time, depth, line", r.name, frames,
                                 layout.shape.size()));
  r.frames = layout.shape[0];
  r.samples = layout.shape[1];
  r.lines = layout.shape[2];
  checkRecording(r);
  const ZarrValues<std::uint8_t> bytes = store.bytes(frames, kMostRecordingValues);
  if (bytes.absent_chunks > 0)
    r.notes.push_back(fmt::format("{} chunks of its frames are absent: they have the fill value",
                                  bytes.absent_chunks));
  for (std::size_t f = 0; f < r.frames; ++f)
    r.greys.push_back(linesFirst(r, bytes.values, f, [](std::uint8_t grey) { return grey; }));
  const std::string times = manifest.pathOf(sector, "timestamps", kUsualTimes);
  if (times != kUsualTimes || store.has(times)) r.times_s = store.numbers(times, r.frames).values;
  takeEcgOf(store, r);
  return r;
}

}  // namespace echocine::echo
