#include "echo/beam_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "echo/ecg_waves.h"
#include "echo/r_wave_beats.h"
#include "hdf/hdf5_input.h"
#include "scene/scan_geometry.h"
#include "signal/scan_conversion.h"
#include "video/video_builder.h"
#include "zarr/zarr_input.h"

namespace echocine::echo {

namespace fs = std::filesystem;

namespace {

constexpr double kPictureMargin_px = 8;  // of the picture around the sector
constexpr int kMostPixelValues = 4;      // along a pixel's side

[[noreturn]] void refuseRecording(const BeamRecording& r, const std::string& what) {
  throw SceneError(fmt::format("{}: {}", r.name, what));
}

double sampleStep(const BeamRecording& r) {
  return (r.last_depth_m - r.first_depth_m) / (static_cast<double>(r.samples) - 1);
}

// A phased array at the apex: only angles and depths count here.
Probe probeOf(const BeamRecording& r) {
  Probe probe;
  probe.kind = ProbeKind::phased;
  probe.first_angle_rad = r.first_rad;
  probe.last_angle_rad = r.last_rad;
  probe.min_depth_m = r.first_depth_m - 0.5 * sampleStep(r);
  probe.max_depth_m = r.last_depth_m + 0.5 * sampleStep(r);
  probe.lines = static_cast<int>(r.lines);
  probe.samples = static_cast<int>(r.samples);
  probe.frequency_hz = 1;  // not used
  return probe;
}

// Edges of the scan area. The first sample of a recording may reach half its length above the apex.
void takeSector(const BeamRecording& r, const Probe& probe, EchoLoop& loop) {
  const Box area = scanBox(probe);
  const double left = area.lo.x, top = std::min(area.lo.z, area.hi.z), pixel = kRecordingPixel_m;
  const auto side = [&](double length_m) {
    return static_cast<int>(std::ceil(length_m / pixel + 2 * kPictureMargin_px));
  };
  Video& v = loop.video;
  v.width = side(area.hi.x - left);
  v.height = side(area.hi.z - top);
  checkLoopSize(r.name, v.width, v.height, static_cast<std::int64_t>(r.frames));
  loop.metres_per_pixel = pixel;
  loop.scale_source = "recording";
  loop.find.given = true;
  loop.find.sector = {kPictureMargin_px - left / pixel,
                      kPictureMargin_px - top / pixel,
                      r.first_rad,
                      r.last_rad,
                      std::max(0.0, probe.min_depth_m) / pixel,
                      probe.max_depth_m / pixel};
}

void makePictures(const Probe& probe, EchoLoop& loop) {
  Video& v = loop.video;
  PictureGeometry geometry;
  geometry.origin_x_px = loop.sector().apex_x;
  geometry.origin_y_px = loop.sector().apex_y;
  geometry.metres_per_pixel = kRecordingPixel_m;
  const int averaged = static_cast<int>(std::clamp(
      std::ceil(kRecordingPixel_m / probe.sampleSpacing()), 1.0, double{kMostPixelValues}));
  const ScanConverter converter(probe, geometry, v.width, v.height, GreyCurve(), averaged);
  v.frames.resize(loop.traced.frames.size());
  parallelBlocks(v.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      std::vector<float> greys = loop.traced.frames[f];
      for (float& grey : greys) grey /= 255;
      GreyImage image;
      converter.convert(greys, image);
      v.frames[f] = std::move(image.pixels);
    }
  });
  v.coloured.assign(v.frames.front().size(), 0);
  loop.overlay = v.coloured;
}

// A frame of equal values, byte by byte. Tissue at rest still changes, if only by noise.
void findEqualFrames(const BeamRecording& r, EchoLoop& loop) {
  for (std::size_t f = 1; f < loop.traced.frames.size(); ++f)
    if (loop.traced.frames[f] == loop.traced.frames[f - 1])
      loop.video.repeats.push_back(static_cast<int>(f));
  if (loop.video.repeats.size() + 1 == r.frames)
    refuseRecording(r,
                    fmt::format("its {} frames are identical; give a loop that moves", r.frames));
}

bool increases(const std::vector<double>& times_s) {
  for (std::size_t i = 0; i < times_s.size(); ++i)
    if (!std::isfinite(times_s[i]) || (i > 0 && !(times_s[i] > times_s[i - 1]))) return false;
  return true;
}

void takeRate(const BeamRecording& r, Video& video) {
  if (r.times_s.empty()) return;
  if (r.times_s.size() != r.frames)
    refuseRecording(r, fmt::format("{} timestamps for {} frames, accepted: one each",
                                   r.times_s.size(), r.frames));
  if (!increases(r.times_s)) refuseRecording(r, "its timestamps do not increase");
  const double steps = static_cast<double>(r.frames) - 1,
               hz = steps / (r.times_s.back() - r.times_s.front());
  if (!(hz >= kLeastFrameRate_hz && hz <= kMostFrameRate_hz))
    refuseRecording(r, fmt::format("its timestamps mean {:.3g} frames/s, accepted: {:g} to {:g}",
                                   hz, kLeastFrameRate_hz, kMostFrameRate_hz));
  video.rate = {hz, "timestamps", true};
  double longest = 0;
  for (std::size_t i = 1; i < r.frames; ++i)
    longest = std::max(longest, r.times_s[i] - r.times_s[i - 1]);
  noteUnevenFrames(longest, 1 / hz, video);
}

// Between samples: the peak of the parabola through three of them.
double peakAbout(const std::vector<double>& y, double at) {
  const auto i = static_cast<std::size_t>(std::lround(at));
  if (i == 0 || i + 1 >= y.size() || at != std::round(at)) return at;
  const double bend = y[i - 1] - 2 * y[i] + y[i + 1];
  if (bend == 0) return at;
  return at + std::clamp(0.5 * (y[i - 1] - y[i + 1]) / bend, -0.5, 0.5);
}

// Times of R waves on the clock of the frames.
std::vector<double> rWavesOf(const BeamRecording& r, Video& video) {
  if (r.ecg.empty()) return {};
  const auto [least, most] = std::minmax_element(r.ecg.begin(), r.ecg.end());
  if (!(*most > *least)) return {};
  constexpr double kHeight = 1000;  // findRWaves() counts heights in units of the trace's thickness
  std::vector<double> heights;
  for (const double y : r.ecg) heights.push_back(kHeight * (y - *least) / (*most - *least));
  const RWaves found = findRWaves(heights, 1);
  if (found.confidence < kEcgConfident) {
    video.notes.push_back("its ECG shows no clear R waves: not used");
    return {};
  }
  std::vector<double> waves_s;
  for (const double at : found.at) {
    const double place = peakAbout(heights, at);
    const auto i = std::min(static_cast<std::size_t>(std::max(0.0, place)), r.ecg_s.size() - 2);
    waves_s.push_back(r.ecg_s[i] +
                      (place - static_cast<double>(i)) * (r.ecg_s[i + 1] - r.ecg_s[i]));
  }
  return waves_s;
}

void takeEcg(const BeamRecording& r, EchoLoop& loop) {
  Video& v = loop.video;
  if (r.ecg.size() < 3 || r.times_s.empty()) return;
  const bool sound =
      r.ecg_s.size() == r.ecg.size() && increases(r.ecg_s) &&
      std::all_of(r.ecg.begin(), r.ecg.end(), [](double y) { return std::isfinite(y); });
  if (!sound) {
    v.notes.push_back("its ECG has no usable times or values: not used");
    return;
  }
  const std::vector<double> waves_s = rWavesOf(r, v);
  for (const double wave_s : waves_s) {
    const double at = wave_s - r.times_s.front(), half = 0.5 / v.rate.hz;
    if (at > -half && wave_s <= r.times_s.back() + half) v.r_waves_s.push_back(std::max(0.0, at));
  }
  if (!v.r_waves_s.empty()) loop.beat_anchor = "ECG of the recording";
  if (waves_s.size() < 2) return;
  v.heart_rate_bpm = 60 / beatOfRWaves(waves_s, 0).median;
  v.heart_rate_source = "ECG of the recording";
}

bool hasExtension(const fs::path& path, const char* extension) {
  const fs::path name = path.has_filename() ? path : path.parent_path();
  return name.extension() == extension;
}

bool isFolder(const fs::path& path) {
  std::error_code failed;
  return fs::is_directory(path, failed);
}

}  // namespace

void checkRecording(const BeamRecording& r) {
  constexpr std::size_t kMostLines = 4096, kMostSamples = 16384;
  if (r.lines < 2 || r.lines > kMostLines || r.samples < 2 || r.samples > kMostSamples)
    refuseRecording(r, fmt::format("{} lines of {} samples, accepted: 2 to {} of 2 to {}", r.lines,
                                   r.samples, kMostLines, kMostSamples));
  if (r.frames < 2 || r.frames > kMaxLoopFrames)
    refuseRecording(r, fmt::format("{} frames, accepted: 2 to {}", r.frames, kMaxLoopFrames));
  if (r.frames > kMostRecordingValues / (r.lines * r.samples))
    refuseRecording(
        r, fmt::format("more than {} values; give a shorter part of it", kMostRecordingValues));
  const double first = r.first_rad, last = r.last_rad, most = kMostRecordingAngle_rad;
  if (!(first >= -most && last <= most && last - first >= 0.01))
    refuseRecording(r,
                    fmt::format("its lines run from {:.3g} to {:.3g} rad, accepted: -{:g} to {:g}, "
                                "increasing",
                                first, last, most, most));
  const double near_m = r.first_depth_m, far_m = r.last_depth_m;
  if (!(near_m >= 0 && far_m <= kMostRecordingDepth_m && far_m - near_m >= 0.01))
    refuseRecording(r, fmt::format("its samples run from {:.3g} to {:.3g} m, accepted: 0 to {:g}, "
                                   "increasing, 0.01 and more",
                                   near_m, far_m, kMostRecordingDepth_m));
}

bool isBeamRecording(const fs::path& path) {
  std::error_code failed;
  if (isFolder(path))
    return isZarrStore(path) || hasExtension(path, ".zarr") ||
           fs::is_regular_file(path / "croissant.json", failed);
  return fs::is_regular_file(path, failed) &&
         (looksLikeHdf5(path) || hasExtension(path, ".zarr") || hasExtension(path, ".hdf5"));
}

EchoLoop readBeamRecording(const fs::path& path) {
  const std::string name = path.string();
  if (isFolder(path) && !isZarrStore(path) && !hasExtension(path, ".zarr"))
    throw SceneError(fmt::format(
        "{}: is a catalogue of recordings; give one of them, such as EXAM/RECORDING.zarr", name));
  if (!isFolder(path) && hasExtension(path, ".zarr"))
    throw SceneError(fmt::format("{}: is a packed store; unpack it into a folder", name));
  BeamRecording r = isFolder(path) ? readEchoXFlow(path) : readZea(path);
  checkRecording(r);
  EchoLoop loop;
  loop.video.name = r.name;
  loop.video.format = r.format;
  loop.video.notes = r.notes;
  const Probe probe = probeOf(r);
  takeSector(r, probe, loop);
  takeRate(r, loop.video);
  takeEcg(r, loop);
  loop.grey_source = "beam space";
  loop.traced = {probe.lines,       probe.samples,     r.first_rad,       r.last_rad,
                 probe.min_depth_m, probe.max_depth_m, std::move(r.greys)};
  findEqualFrames(r, loop);
  makePictures(probe, loop);
  return loop;
}

}  // namespace echocine::echo
