// Files of a render's folder as arrays.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/error.h"
#include "dataset/sink.h"
#include "export/export_loops.h"
#include "output/exr_plane.h"
#include "output/exr_stack.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/job.h"
#include "python/unlocked.h"
#include "scene/names.h"
#include "video/read_video.h"

namespace echocine::python {

namespace {

using Path = std::filesystem::path;

Channel channelFrom(const std::string& name) {
  std::string accepted;
  const auto look = [&](const auto& channels) -> std::optional<Channel> {
    for (const Channel c : channels) {
      if (channelName(c) == name) return c;
      accepted += fmt::format("{}{}", accepted.empty() ? "" : ", ", channelName(c));
    }
    return std::nullopt;
  };
  if (const auto found = look(kAllChannels)) return *found;
  if (const auto found = look(kTruthChannels)) return *found;
  throw SceneError(fmt::format("channel: \"{}\" is not a channel, accepted: {}", name, accepted));
}

// Moves a vector into an array of its own.
template <typename T>
py::array arrayOf(std::vector<T> values, const std::vector<py::ssize_t>& shape) {
  auto* kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return viewOf(kept->data(), shape, owner);
}

// (depth, line)
template <typename T>
py::array planeOf(std::optional<std::vector<T>> values, const ExrPlaneWanted& wanted,
                  const Path& file) {
  if (!values)
    throw JobError(fmt::format("{}: is absent, damaged, of another scene, or has no channel {}",
                               file.string(), channelName(wanted.channel)));
  return arrayOf(std::move(*values), {wanted.lines, wanted.samples}).attr("T");
}

// Any scale of half floats undone.
py::array readExr(const Path& folder, int frame, const std::string& channel,
                  const std::string& sha256, int lines, int samples) {
  const ExrPlaneWanted wanted{channelFrom(channel), sha256, frame, lines, samples};
  const Path file = folder / ExrStack::fileName(frame);
  std::optional<std::vector<float>> values;
  std::optional<std::vector<std::uint32_t>> ids;
  {
    const Unlocked released;
    if (isLabel(wanted.channel))
      ids = readExrIds(file, wanted);
    else
      values = readExrPlane(file, wanted);
  }
  return isLabel(wanted.channel) ? planeOf(std::move(ids), wanted, file)
                                 : planeOf(std::move(values), wanted, file);
}

py::array readFrames(const Path& path) {
  Video video;
  runJob(py::none(), [&](const Monitor&) { video = readVideo(path); });
  std::vector<std::uint8_t> pixels;
  for (const PixelPlane& frame : video.frames)
    pixels.insert(pixels.end(), frame.begin(), frame.end());
  return arrayOf(std::move(pixels), {video.frameCount(), video.height, video.width});
}

// Size and digest of a file, as a dataset's records have them.
std::pair<std::uint64_t, std::string> fileDigest(const Path& path) {
  const Unlocked released;
  const std::optional<dataset::FileMark> mark = dataset::markOf(path);
  if (!mark)
    throw JobError(fmt::format("{}: cannot be read, or is not a regular file", path.string()));
  return {mark->bytes, mark->digest};
}

// (codec, width, height, frames, frame_rate_hz); only_check: of nothing, before loops are rendered
// for it.
py::tuple exportTo(const std::vector<Path>& loops, const Path& output,
                   const std::vector<std::string>& captions, int columns, int width, int repeats,
                   double speed, std::optional<double> fps, const std::string& tint, int threads,
                   bool only_check, const py::object& progress) {
  ExportOptions options{loops, output, captions, columns, width, repeats, speed, fps};
  options.threads = threads;
  const std::optional<Tint> known = valueOf<Tint>(tint);
  if (!known) throw SceneError(fmt::format("tint: \"{}\", accepted: none, sepia, blue", tint));
  options.tint = *known;
  Exported exported;
  runJob(progress, [&](const Monitor& monitor) {
    if (only_check) return checkExport(options);
    exported = exportLoops(options);
    for (const std::string& note : exported.notes) monitor.warn(note);
  });
  return py::make_tuple(exported.codec, exported.width, exported.height, exported.frames,
                        exported.frame_rate_hz);
}

}  // namespace

void bindFiles(py::module_& module) {
  module.def("read_exr", &readExr, py::arg("folder"), py::arg("frame"), py::arg("channel"),
             py::arg("scene_sha256"), py::arg("lines"), py::arg("samples"),
             "One channel of an intensity EXR, (depth, line) float32 or uint32.");
  module.def("export_loops", &exportTo, py::arg("loops"), py::arg("output"), py::arg("captions"),
             py::arg("columns"), py::arg("width"), py::arg("repeats"), py::arg("speed"),
             py::arg("fps"), py::arg("tint"), py::arg("threads"), py::arg("only_check"),
             py::arg("progress"), "Loops as MP4, GIF or WebP.");
  module.def("file_digest", &fileDigest, py::arg("path"), "(bytes, digest) of a file.");
  module.def("read_video", &readFrames, py::arg("path"), "(T, H, W) uint8 greys of a video.");
}

}  // namespace echocine::python
