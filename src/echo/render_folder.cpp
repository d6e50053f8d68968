#include "echo/render_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/seal.h"
#include "output/exr_plane.h"
#include "output/exr_stack.h"
#include "scene/names.h"
#include "signal/picture.h"
#include "video/read_video.h"
#include "video/video_builder.h"

namespace echocine::echo {

namespace {

using UnorderedJson = nlohmann::json;
constexpr std::size_t kMaxManifest = std::size_t{1} << 28;

// The picture's geometry is worked out by the very function that rendered it, not read off the
// pixels.
void takeGeometry(const UnorderedJson& scene, EchoLoop& loop, const std::string& name) {
  const UnorderedJson &p = scene.at("probe"), &o = scene.at("output");
  const auto kind = valueOf<ProbeKind>(p.at("kind").get<std::string>());
  if (!kind || !layoutOf(*kind).fan || layoutOf(*kind).full_turn)
    throw SceneError(
        fmt::format("{}: a {} probe has no sector; render the view with a phased or "
                    "curvilinear one",
                    name, kind ? nameOf(*kind) : "linear"));
  Scene s;  // what the picture's geometry depends on
  s.probe.kind = *kind;
  s.probe.first_angle_rad = p.at("first_angle_rad");
  s.probe.last_angle_rad = p.at("last_angle_rad");
  s.probe.face_radius_m = p.at("face_radius_m");
  s.probe.min_depth_m = p.at("min_depth_m");
  s.probe.max_depth_m = p.at("max_depth_m");
  s.probe.lines = p.at("lines");
  s.probe.samples = p.at("samples");
  s.output.width = o.at("width");
  s.output.height = o.at("height");
  s.output.ecg = o.at("ecg");
  s.output.depth_ticks = o.at("depth_ticks");
  s.output.cine = true;
  if (s.output.width != loop.video.width || s.output.height != loop.video.height)
    throw SceneError(
        fmt::format("{}: its cine is {} x {} pixels, its manifest says {} x {}; render it "
                    "again",
                    name, loop.video.width, loop.video.height, s.output.width, s.output.height));
  const PictureGeometry g = pictureGeometry(s);
  if (!(g.metres_per_pixel > 0 && std::isfinite(g.metres_per_pixel)))
    throw SceneError(
        fmt::format("{}: manifest.json: its probe has no extent; render it again", name));
  loop.metres_per_pixel = g.metres_per_pixel;
  loop.scale_source = "manifest";
  loop.find.given = true;
  loop.find.sector = {g.origin_x_px,
                      g.origin_y_px,
                      s.probe.first_angle_rad,
                      s.probe.last_angle_rad,
                      (s.probe.face_radius_m + s.probe.min_depth_m) / g.metres_per_pixel,
                      (s.probe.face_radius_m + s.probe.max_depth_m) / g.metres_per_pixel};
}

// By the role that the manifest has, else by the name.
std::string leftVentricle(const UnorderedJson& structures) {
  for (const UnorderedJson& structure : structures) {
    const std::string name = structure.at("name");
    const Role role = structure.contains("role")
                          ? valueOf<Role>(structure["role"].get<std::string>()).value_or(Role::none)
                          : guessRole(name);
    if (role == Role::lv_cavity) return name;
  }
  return "";
}

[[noreturn]] void failOfDamage(const std::string& name, const char* what) {
  throw SceneError(fmt::format("{}: manifest.json is damaged ({}); render it again", name, what));
}

// Frames per beat from the phases, which count on from frame to frame.
void takeFrames(const UnorderedJson& frames, EchoLoop& loop) {
  std::vector<double> times;
  for (const UnorderedJson& f : frames) {
    loop.phases.push_back(f.at("phase"));
    times.push_back(f.at("time_s"));
    std::size_t i = 0;
    if (times.size() > 1 && f.at("volumes_ml").size() != loop.volumes_ml.size())
      failOfDamage(loop.video.name, "its frames have other structures");
    for (const auto& [name, ml] : f.at("volumes_ml").items()) {
      if (loop.volumes_ml.size() <= i) loop.volumes_ml.push_back({name, {}});
      loop.volumes_ml[i++].second.push_back(ml);
    }
  }
  // Beats gone by: each step forwards, modulo 1. Preconditions: under one beat from frame to frame.
  double turned = 0;
  for (std::size_t i = 1; i < loop.phases.size(); ++i) {
    const double step = loop.phases[i] - loop.phases[i - 1];
    turned += step - std::floor(step);
  }
  constexpr double kMostOfBeat = 1e6;  // frames: a minute at the fastest rate. Our choice
  const double steps = static_cast<double>(loop.phases.size()) - 1;
  if (turned * kMostOfBeat > steps) loop.frames_per_beat = steps / turned;
  if (times.size() < 2) return;
  constexpr double kLeast_hz = 0.05, kMost_hz = 2e5;  // scenes have 0.1 to 1e5
  const double hz = steps / (times.back() - times.front());
  if (!(hz > kLeast_hz && hz < kMost_hz))
    failOfDamage(loop.video.name, "its frames' times are no loop's");
  loop.video.rate = {hz, "manifest", true};
}

// The files of a folder, by the digests in its manifest.
class RenderedFiles {
 public:
  RenderedFiles(std::filesystem::path folder, const UnorderedJson& digests)
      : folder_(std::move(folder)), digests_(digests.get<std::map<std::string, std::string>>()) {}

  const std::filesystem::path& folder() const { return folder_; }

  // Is the file there with the bytes that were written?
  bool holds(const std::string& name) const {
    const auto noted = digests_.find(name);
    std::error_code failed;
    return noted != digests_.end() && std::filesystem::is_regular_file(folder_ / name, failed) &&
           sha256HexOfFile(folder_ / name) == noted->second;
  }

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::string> digests_;
};

// The exact greys, when every frame's EXR has them. `numbers`: of the frames in the scene's loop.
void takeTracedGreys(const RenderedFiles& files, const UnorderedJson& scene,
                     const std::vector<int>& numbers, EchoLoop& loop) {
  loop.grey_source = "cine.avi";
  const UnorderedJson &p = scene.at("probe"), &channels = scene.at("output").at("channels");
  if (std::find(channels.begin(), channels.end(), channelName(Channel::display)) ==
          channels.end() ||
      !scene.at("output").at("exr").get<bool>())
    return;
  TracedGreys t;
  t.lines = p.at("lines");
  t.samples = p.at("samples");
  t.first_rad = p.at("first_angle_rad");
  t.last_rad = p.at("last_angle_rad");
  t.near_m = p.at("face_radius_m").get<double>() + p.at("min_depth_m").get<double>();
  t.far_m = p.at("face_radius_m").get<double>() + p.at("max_depth_m").get<double>();
  const int frames = loop.video.frameCount();
  // The manifest may be damaged; memory stays within what a video of its length may take.
  if (t.lines < 2 || t.samples < 2 || t.lines > kMaxLoopPixels / t.samples / frames) return;
  t.frames.resize(static_cast<std::size_t>(frames));
  // One bad frame is enough: a mix of exact and decoded greys would step in brightness.
  std::atomic<int> unread{-1};
  parallelBlocks(t.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end && unread < 0; ++f) {
      const int frame = numbers[f];
      const std::string exr = "intensity/" + ExrStack::fileName(frame);
      std::optional<std::vector<float>> plane;
      if (files.holds(exr))
        plane = readExrPlane(files.folder() / exr,
                             {Channel::display, loop.scene_sha256, frame, t.lines, t.samples});
      if (!plane) {
        unread = frame;
        return;
      }
      for (float& grey : *plane) grey *= 255;
      t.frames[f] = std::move(*plane);
    }
  });
  if (unread >= 0) {
    loop.video.notes.push_back(
        "EXR files are missing or not as they were written: grey levels are those of cine.avi");
    return;
  }
  loop.grey_source = "EXR display.Y";
  loop.traced = std::move(t);
}

}  // namespace

bool isRenderFolder(const std::filesystem::path& path) {
  std::error_code failed;
  return std::filesystem::is_regular_file(path / "manifest.json", failed);
}

bool holdsOwnCine(const std::filesystem::path& folder) {
  if (!isRenderFolder(folder)) return false;
  const std::string text = readTextFile(folder / "manifest.json", kMaxManifest);
  if (!isSealed(text)) return false;
  try {
    return RenderedFiles(folder, UnorderedJson::parse(text).at("files")).holds("cine.avi");
  } catch (const UnorderedJson::exception&) {
    failOfDamage(folder.string(), "a key is absent or of another type");
  }
}

// The manifest is written last, so a folder that has one is whole unless files were taken away
// since.
EchoLoop readRenderFolder(const std::filesystem::path& folder) {
  const std::string name = folder.string();
  std::error_code failed;
  if (!std::filesystem::is_regular_file(folder / "cine.avi", failed))
    throw SceneError(
        fmt::format("{}: has no cine.avi; render the scene with output.cine = true", name));
  EchoLoop loop;
  try {
    const std::string text = readTextFile(folder / "manifest.json", kMaxManifest);
    if (!isSealed(text)) failOfDamage(name, "it is not as it was written");
    const UnorderedJson manifest = UnorderedJson::parse(text);
    const RenderedFiles files(folder, manifest.at("files"));
    if (!files.holds("cine.avi"))
      throw SceneError(fmt::format("{}: cine.avi is not as it was written; render it again", name));
    loop.video = readVideo(folder / "cine.avi");
    loop.video.name = name;
    loop.video.format = "render folder";
    loop.video.repeats.clear();  // frames that do not move are no repeats here
    takeGeometry(manifest.at("scene"), loop, name);
    takeFrames(manifest.at("frames"), loop);
    std::vector<int> numbers;
    for (const UnorderedJson& frame : manifest.at("frames")) numbers.push_back(frame.at("index"));
    loop.lv_cavity = leftVentricle(manifest.at("scene").at("structures"));
    loop.scene_sha256 = manifest.at("scene_sha256");
    if (loop.phases.size() == loop.video.frames.size())
      takeTracedGreys(files, manifest.at("scene"), numbers, loop);
  } catch (const UnorderedJson::exception&) {  // its words are not for users
    failOfDamage(name, "a key is absent or of another type");
  }
  if (loop.phases.size() != loop.video.frames.size())
    throw SceneError(fmt::format("{}: cine.avi has {} frames, manifest.json {}; render it again",
                                 name, loop.video.frames.size(), loop.phases.size()));
  loop.overlay.assign(loop.video.frames.front().size(), 0);
  return loop;
}

}  // namespace echocine::echo
