// zea (github.com/tue-bmd/zea, layout of 2026): the map data/image with coordinates, and the ECG.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/vec3.h"
#include "echo/beam_recording.h"
#include "hdf/hdf5_input.h"

namespace echocine::echo {

namespace {

// Decibels of float images are shown over this range; our choice.
constexpr double kShownRange_db = 60;

constexpr std::size_t kMostPlaces = std::size_t{1} << 26;  // coordinates
constexpr std::size_t kMostVersion = 100;

// Answers to the queries of readZea(), in their order.
struct Zea {
  enum : std::size_t { version, values, places, times, offset, plain };
  enum : std::size_t { ecg = plain + 4, ecg_rate, ecg_times, ecg_offset };
};

std::vector<Hdf5Query> queriesOf() {
  std::vector<Hdf5Query> out{{"zea_version", kMostVersion, true}};
  // With tracks, and files of one track without.
  for (const std::string group : {"tracks/track_0/data/image/", "data/image/"}) {
    out.push_back({group + "values", kMostRecordingValues});
    out.push_back({group + "coordinates", kMostPlaces});
    out.push_back({group + "timestamps", std::size_t{1} << 16});
    out.push_back({group + "start_time_offset", 1});
  }
  out.push_back({"metadata/ecg/samples", kMostEcgSamples});
  out.push_back({"metadata/ecg/sampling_frequency", 1});
  out.push_back({"metadata/ecg/timestamps", kMostEcgSamples});
  out.push_back({"metadata/ecg/start_time_offset", 1});
  return out;
}

const std::vector<float>& floatsOf(const BeamRecording& r, const Hdf5Values& given,
                                   const char* what) {
  const auto* floats = std::get_if<std::vector<float>>(&given.values);
  if (floats == nullptr) throw SceneError(fmt::format("{}: {}: are no float32", r.name, what));
  return *floats;
}

double zeaNumber(const BeamRecording& r, const Hdf5Values& given, const char* what, double absent) {
  return given.found ? static_cast<double>(floatsOf(r, given, what).front()) : absent;
}

// Places of the samples (sample, line): lateral and depth.
class SampleGrid {
 public:
  SampleGrid(const BeamRecording& r, const std::vector<float>& places) : r_(r), places_(places) {}

  Vec3d at(std::size_t sample, std::size_t line) const {
    const float* p = places_.data() + 3 * (sample * r_.lines + line);
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  }

  // Where the first and the last line meet.
  Vec3d apex() const {
    const std::size_t last = r_.samples - 1;
    const Vec3d a = at(0, 0), u = at(last, 0) - a, b = at(0, r_.lines - 1),
                v = at(last, r_.lines - 1) - b;
    const double across = u.x * v.z - u.z * v.x;
    if (!(std::abs(across) > 0.01 * length(u) * length(v))) refuse();
    const double along = ((b.x - a.x) * v.z - (b.z - a.z) * v.x) / across;
    return a + along * u;
  }

  // Every sample against the even grid about the apex, within a twentieth of the finer step.
  void check(Vec3d apex, const BeamRecording& found) const {
    const double depth_step =
        (found.last_depth_m - found.first_depth_m) / (static_cast<double>(r_.samples) - 1);
    const double angle_step =
        (found.last_rad - found.first_rad) / (static_cast<double>(r_.lines) - 1);
    // Angles close to the apex are those of rounded numbers.
    const double most_m = 0.05 * depth_step + 1e-7;
    for (std::size_t k = 0; k < r_.samples; ++k)
      for (std::size_t i = 0; i < r_.lines; ++i) {
        const double depth = found.first_depth_m + static_cast<double>(k) * depth_step,
                     angle = found.first_rad + static_cast<double>(i) * angle_step;
        const Vec3d even = apex + depth * Vec3d{std::sin(angle), 0, std::cos(angle)};
        if (!(length(at(k, i) - even) <= most_m)) refuse();
      }
  }

  [[noreturn]] void refuse() const {
    throw SceneError(
        fmt::format("{}: the coordinates of its image are no sector, accepted: even lines that "
                    "meet in a point, with even samples",
                    r_.name));
  }

 private:
  const BeamRecording& r_;
  const std::vector<float>& places_;
};

void takeShape(const Hdf5Values& image, const Hdf5Values& coordinates, BeamRecording& r) {
  if (image.shape.size() != 3)
    throw SceneError(fmt::format("{}: its image has {} axes, accepted: frame, z, x", r.name,
                                 image.shape.size()));
  r.frames = image.shape[0];
  r.samples = image.shape[1];
  r.lines = image.shape[2];
  if (coordinates.shape != std::vector<std::size_t>{r.samples, r.lines, 3})
    throw SceneError(fmt::format("{}: its image has no coordinates of shape {}, {}, 3", r.name,
                                 r.samples, r.lines));
  if (r.samples < 2 || r.lines < 2)
    throw SceneError(fmt::format("{}: its image has one sample or line", r.name));
}

void takePlaces(const std::vector<float>& places_m, BeamRecording& r) {
  const SampleGrid grid(r, places_m);
  const Vec3d apex = grid.apex();
  const Vec3d first = grid.at(0, 0) - apex, last = grid.at(r.samples - 1, 0) - apex,
              right = grid.at(r.samples - 1, r.lines - 1) - apex;
  r.first_rad = std::atan2(last.x, last.z);
  r.last_rad = std::atan2(right.x, right.z);
  r.first_depth_m = length(first);
  r.last_depth_m = length(last);
  checkRecording(r);
  grid.check(apex, r);
}

void takeGreys(const Hdf5Values& image, BeamRecording& r) {
  const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&image.values);
  if (bytes == nullptr)
    r.notes.push_back(fmt::format(
        "its image is in dB: grey levels show the range from -{:g} to 0 dB", kShownRange_db));
  for (std::size_t f = 0; f < r.frames; ++f)
    r.greys.push_back(bytes != nullptr
                          ? linesFirst(r, *bytes, f, [](std::uint8_t grey) { return grey; })
                          : linesFirst(r, floatsOf(r, image, "values"), f, [](float level_db) {
                              const double level = static_cast<double>(level_db);
                              return std::isnan(level)
                                         ? 0.0
                                         : 255 * std::clamp(1 + level / kShownRange_db, 0.0, 1.0);
                            }));
}

void takeZeaEcg(const std::vector<Hdf5Values>& all, BeamRecording& r) {
  if (!all[Zea::ecg].found) return;
  const std::vector<float>& samples = floatsOf(r, all[Zea::ecg], "metadata/ecg/samples");
  r.ecg.assign(samples.begin(), samples.end());
  const double start_s = zeaNumber(r, all[Zea::ecg_offset], "metadata/ecg/start_time_offset", 0),
               rate_hz = zeaNumber(r, all[Zea::ecg_rate], "metadata/ecg/sampling_frequency", 0);
  if (all[Zea::ecg_times].found)
    for (const float time_s : floatsOf(r, all[Zea::ecg_times], "metadata/ecg/timestamps"))
      r.ecg_s.push_back(start_s + static_cast<double>(time_s));
  else if (rate_hz > 0)
    for (std::size_t i = 0; i < samples.size(); ++i)
      r.ecg_s.push_back(start_s + static_cast<double>(i) / rate_hz);
}

}  // namespace

BeamRecording readZea(const std::filesystem::path& file) {
  const std::vector<Hdf5Query> queries = queriesOf();
  const std::vector<Hdf5Values> all = readHdf5(file, queries);
  BeamRecording r;
  r.name = file.string();
  r.format = "zea";
  if (!all[Zea::version].found)
    throw SceneError(fmt::format("{}: has no attribute zea_version: is no file of zea", r.name));
  const std::size_t group = all[Zea::values].found ? 0 : Zea::plain - 1;
  const Hdf5Values &image = all[Zea::values + group], &coordinates = all[Zea::places + group],
                   &seconds = all[Zea::times + group];
  if (!image.found)
    throw SceneError(fmt::format("{}: has no image in tracks/track_0/data or data", r.name));
  takeShape(image, coordinates, r);
  takePlaces(floatsOf(r, coordinates, "coordinates"), r);
  takeGreys(image, r);
  const double start_s = zeaNumber(r, all[Zea::offset + group], "start_time_offset", 0);
  if (seconds.found)
    for (const float time_s : floatsOf(r, seconds, "timestamps"))
      r.times_s.push_back(start_s + static_cast<double>(time_s));
  takeZeaEcg(all, r);
  return r;
}

}  // namespace echocine::echo
