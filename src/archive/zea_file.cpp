#include "archive/zea_file.h"

#include <fmt/format.h>

#include <span>

#include "core/error.h"
#include "core/file.h"
#include "core/output_check.h"
#include "hdf/hdf5_file.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// The release whose layout this is, as files of that release state it.
constexpr char kZeaVersion[] = "0.1.0";

// Centres of the samples: lateral, elevation, depth in the probe frame.
std::vector<float> coordinatesOf(const BeamLoop& loop) {
  const ScanGeometry geometry(loop.scene.probe);
  std::vector<float> places_m;
  for (int k = 0; k < loop.samples; ++k)
    for (int i = 0; i < loop.lines; ++i) {
      const LineGeometry line = lineGeometry(loop.scene.probe, i);
      const Vec3d p = line.origin + geometry.sampleDepth(k) * line.direction;
      for (const double along : {p.x, p.y, p.z}) places_m.push_back(static_cast<float>(along));
    }
  return places_m;
}

void refuseBlank(const std::string& subject) {
  if (subject.find_first_not_of(' ') == std::string::npos)
    throw SceneError("--exam: is empty, accepted: a name");
}

}  // namespace

void checkZea(const std::filesystem::path& file, const std::string& subject) {
  if (!subject.empty()) refuseBlank(subject);
  checkOutputFile(file);
}

void writeZea(const BeamLoop& loop, const std::filesystem::path& file, const std::string& subject) {
  refuseBlank(subject);
  const auto t = static_cast<std::size_t>(loop.frames), z = static_cast<std::size_t>(loop.samples),
             x = static_cast<std::size_t>(loop.lines);
  const std::vector<float> coordinates = coordinatesOf(loop);
  const std::vector<std::uint8_t> greys = bytesOfGreys(loop);
  const float frame_rate_hz = static_cast<float>(loop.scene.acquisition.frame_rate_hz),
              ecg_rate_hz = static_cast<float>(kEcgRate_hz), start_s = 0,
              ecg_start_s = static_cast<float>(-kEcgMargin_s);
  const auto floats = [](std::span<const float> values) { return values; };
  const auto one = [](const float& value) { return std::span(&value, 1); };
  const std::string image = "tracks/track_0/data/image/", ecg = "metadata/ecg/",
                    doppler = "tracks/track_0/data/tissue_doppler/",
                    strain = "metadata/longitudinal_strain/";
  std::vector<Hdf5Array> arrays{
      {image + "values", {t, z, x}, std::span<const std::uint8_t>(greys), true},
      {image + "coordinates", {z, x, 3}, floats(coordinates), true},
      {image + "timestamps", {t}, floats(loop.times_s)},
      {image + "start_time_offset", {}, one(start_s)},
      {doppler + "values", {t, z, x}, floats(loop.beam_m_s), true},
      {doppler + "coordinates", {z, x, 3}, floats(coordinates), true},
      {doppler + "timestamps", {t}, floats(loop.times_s)},
      {doppler + "start_time_offset", {}, one(start_s)},
      {doppler + "unit", {}, std::string("m/s")},
      {"metadata/subject/id", {}, subject},
      {ecg + "samples", {loop.ecg.size()}, floats(loop.ecg)},
      {ecg + "sampling_frequency", {}, one(ecg_rate_hz)},
      {ecg + "start_time_offset", {}, one(ecg_start_s)}};
  if (!loop.strain_percent.empty()) {
    arrays.push_back({strain + "samples", {t}, floats(loop.strain_percent)});
    arrays.push_back({strain + "sampling_frequency", {}, one(frame_rate_hz)});
    arrays.push_back({strain + "start_time_offset", {}, one(start_s)});
  }
  const Hdf5Attribute attributes[] = {
      {"zea_version", kZeaVersion},
      {"probe_name", "generic"},
      {"description", fmt::format("EchoCine {}, scene {}", ECHOCINE_VERSION, loop.scene_sha256)}};
  writeFileWhole(file, hdf5Bytes(arrays, attributes));
}

}  // namespace echocine
