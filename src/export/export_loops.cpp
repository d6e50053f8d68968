#include "export/export_loops.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/file.h"
#include "core/output_check.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "echo/read_loop.h"
#include "echo/render_folder.h"
#include "export/montage.h"
#include "video/read_video.h"

namespace echocine {

namespace fs = std::filesystem;

namespace {

void checkRange(const char* name, double value, double least, double most) {
  if (!(value >= least && value <= most))
    throw SceneError(fmt::format("{}: {:g}, accepted: {:g} to {:g}", name, value, least, most));
}

void checkOptions(const ExportOptions& o) {
  if (!animationFormatOf(o.output))
    throw SceneError(fmt::format(
        "{}: the extension selects the format, accepted: .mp4, .gif, .webp", o.output.string()));
  checkRange("loops", static_cast<double>(o.loops.size()), 1,
             static_cast<double>(kMostExportedLoops));
  if (!o.captions.empty() && o.captions.size() != o.loops.size())
    throw SceneError(fmt::format("--captions: {} for {} loops; give one per loop",
                                 o.captions.size(), o.loops.size()));
  for (const std::string& caption : o.captions)  // the font has these characters only
    if (!std::all_of(caption.begin(), caption.end(), [](char c) { return c >= ' ' && c <= '~'; }))
      throw SceneError(fmt::format(
          "--captions: \"{}\" cannot be drawn, accepted: ASCII letters, digits and signs",
          caption));
  checkRange("--columns", o.columns, 0, static_cast<double>(kMostExportedLoops));
  if (o.width != 0) checkRange("--width", o.width, kLeastExportWidth, kMostExportWidth);
  checkRange("--repeats", o.repeats, 1, kMostRepeats);
  checkRange("--speed", o.speed, kLeastSpeed, kMostSpeed);
  for (const fs::path& loop : o.loops) {
    std::error_code missing;
    if (fs::equivalent(loop, o.output, missing))
      throw SceneError(fmt::format("{}: is a loop to read; write to another file", loop.string()));
  }
}

// A loop, and its frame rate as played.
struct ReadLoop {
  MontageLoop loop;
  double rate_hz = 0;
};

Video readFrames(const fs::path& path, const std::optional<double>& fps) {
  const fs::path cine = path / "cine.avi";
  std::error_code failed;
  const bool has_cine = fs::is_regular_file(cine, failed);
  if (has_cine && echo::holdsOwnCine(path)) return readVideo(cine);
  echo::SideOptions side;
  side.read_ecg = false;
  side.fps = fps;
  return std::move(echo::readLoop(has_cine ? cine : path, side, true).video);
}

ReadLoop readLoop(const fs::path& path, const ExportOptions& options) {
  Video video = readFrames(path, options.fps);
  ReadLoop read;
  read.rate_hz = options.fps.value_or(video.rate.hz);
  if (!(read.rate_hz > 0))
    throw SceneError(fmt::format("{}: has no frame rate; give --fps", path.string()));
  read.loop.duration_s = video.frameCount() / read.rate_hz;
  for (PixelPlane& frame : video.frames)
    read.loop.frames.push_back({video.width, video.height, std::move(frame)});
  return read;
}

// One loop after the other. The frame rate is that of the fastest one as played.
void addLoops(const ExportOptions& options, Montage& montage, double& first_s, double& rate_hz,
              std::vector<std::string>& notes) {
  for (std::size_t i = 0; i < options.loops.size(); ++i) {
    checkpoint();
    ReadLoop read = readLoop(options.loops[i], options);
    if (!options.captions.empty()) read.loop.caption = options.captions[i];
    if (i == 0) first_s = read.loop.duration_s;
    const double stretch = first_s / read.loop.duration_s;
    if (std::abs(stretch - 1) > 0.02)
      notes.push_back(fmt::format("{}: {:.3g} s are played in {:.3g} s, to stay in phase",
                                  options.loops[i].string(), read.loop.duration_s, first_s));
    rate_hz = std::max(rate_hz, read.rate_hz / stretch * options.speed);
    montage.add(std::move(read.loop));
  }
}

Exported exportWithThreads(const ExportOptions& options) {
  const AnimationFormat format = *animationFormatOf(options.output);
  Exported exported;
  double rate_hz = 0, first_s = 0;
  Montage montage(options.loops.size(), options.columns, options.width,
                  fs::absolute(options.output).parent_path());
  addLoops(options, montage, first_s, rate_hz, exported.notes);
  const double most_hz = format == AnimationFormat::gif ? kMostGifRate_hz : kMostScreenRate_hz;
  if (rate_hz > most_hz) {
    exported.notes.push_back(fmt::format(
        "{:.4g} frames a second are reduced to {:g}; a lower --speed shows more of them", rate_hz,
        most_hz));
    rate_hz = most_hz;
  }
  const double once_s = first_s / options.speed;
  const int once = std::max(1, static_cast<int>(std::lround(once_s * rate_hz)));
  rate_hz = once / once_s;  // a whole number of frames per loop, so that repeats do not jump
  AnimationEncoder encoder(
      {format, montage.width(), montage.height(), rate_hz, coloursOf(options.tint)});
  exported.frames = once * (format == AnimationFormat::mp4 ? options.repeats : 1);
  for (int i = 0; i < exported.frames; ++i) {
    checkpoint();
    encoder.add(montage.at((i % once + 0.5) / once));
  }
  exported.codec = encoder.codec();
  exported.width = montage.width();
  exported.height = montage.height();
  writeFileWhole(options.output, encoder.finish());
  exported.frame_rate_hz = rate_hz;
  return exported;
}

}  // namespace

void checkExport(const ExportOptions& options) {
  checkOptions(options);
  checkOutputFile(options.output);
}

Exported exportLoops(const ExportOptions& options) {
  checkExport(options);
  Exported exported;
  withThreads(options.threads, [&] { exported = exportWithThreads(options); });
  return exported;
}

}  // namespace echocine
