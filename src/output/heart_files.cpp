#include "output/heart_files.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/file.h"
#include "core/folder_lock.h"
#include "core/parallel.h"
#include "motion/heart/truth.h"

namespace echocine {

namespace {

namespace fs = std::filesystem;
using heart::RecordedPart;
using heart::Recording;

// Micrometres, in any locale. Never "-0.000".
void appendMillimetres(std::string& text, double metres) {
  char digits[32];
  const double mm = std::round(metres * 1e6) / 1e3 + 0.0;
  const auto end = std::to_chars(digits, digits + sizeof digits, mm, std::chars_format::fixed, 3);
  text += ' ';
  text.append(digits, end.ptr);
}

std::string vectorText(Vec3d v, double unit) {
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x / unit + 0.0, v.y / unit + 0.0,
                     v.z / unit + 0.0);
}

std::string listText(const std::vector<double>& values) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text += i % 10 == 0 ? ",\n  " : ", ";
    text += fmt::format("{:.6f}", values[i]);
  }
  return text + "]";
}

const char* meaningOf(heart::View view) {
  for (const heart::ViewName& name : heart::viewNames())
    if (name.view == view) return name.meaning;
  return "";
}

std::string structureText(const RecordedPart& part, const std::string& mesh_folder) {
  std::string text = fmt::format("\n[[structure]]\nname = \"{}\"\nmedium = \"{}\"\n",
                                 part.kind.name, part.kind.medium);
  text +=
      part.kind.membrane ? "membrane = true\n" : fmt::format("priority = {}\n", part.kind.priority);
  if (part.kind.reflection_gain != 1)
    text += fmt::format("reflection_gain = {:g}\n", part.kind.reflection_gain);
  const bool still = part.control_m.size() == 1;
  return text + fmt::format("keyframes = \"{}{}{}.obj\"\n", mesh_folder, part.kind.name,
                            still ? "" : "_??");
}

void writeText(const fs::path& file, const std::string& text) {
  writeFileWhole(file, std::as_bytes(std::span(text)));
}

// A folder beside the wanted one, gone again unless it took its place. What a killed run left of
// it is thrown away by the next.
class FolderInTheMaking {
 public:
  explicit FolderInTheMaking(const fs::path& folder) {
    std::error_code failed;
    if (fs::exists(folder, failed)) {
      if (!(fs::is_directory(folder, failed) && fs::is_empty(folder, failed)))
        throw JobError(
            fmt::format("{}: is not empty; give a new folder, so that no keyframes of "
                        "another heart stay among these",
                        folder.string()));
      folder_ = fs::canonical(folder, failed);
    } else {
      const fs::path full = fs::absolute(folder).lexically_normal();
      folder_ = full.has_filename() ? full : full.parent_path();
    }
    const fs::path part = folder_.string() + ".echocine-part";
    fs::create_directories(part, failed);
    if (failed)
      throw JobError(fmt::format("{}: cannot be made: {}", folder.string(), failed.message()));
    lock_.emplace(part);
    lock_->checkStillThere();  // the run that held it before may just have finished
    part_ = part;
    for (fs::directory_iterator it(part_, failed), end; it != end; it.increment(failed))
      fs::remove_all(it->path(), failed);
  }
  ~FolderInTheMaking() {
    std::error_code ignored;
    if (!part_.empty()) fs::remove_all(part_, ignored);
  }
  const fs::path& path() const { return part_; }
  void finish() {
    std::error_code failed;
    fs::rename(part_, folder_, failed);  // an empty folder makes way
    if (failed)
      throw JobError(fmt::format("{}: cannot be made: {}", folder_.string(), failed.message()));
    part_.clear();
  }

 private:
  fs::path folder_, part_;
  std::optional<FolderLock> lock_;
};

}  // namespace

std::string heartMeshName(const RecordedPart& part, std::size_t keyframe) {
  return part.control_m.size() == 1 ? part.kind.name + ".obj"
                                    : fmt::format("{}_{:02d}.obj", part.kind.name, keyframe);
}

std::string heartMesh(const RecordedPart& part, std::size_t keyframe) {
  std::string text;
  for (const Vec3d point : part.control_m[keyframe]) {
    text += 'v';
    for (const double metres : {point.x, point.y, point.z}) appendMillimetres(text, metres);
    text += '\n';
  }
  for (const heart::Face& face : part.faces) {
    text += 'f';
    for (const auto vertex : face) text += ' ' + std::to_string(vertex + 1);  // OBJ counts from 1
    text += '\n';
  }
  for (const SharpVertex& corner : part.tags.vertices)  // as OpenSubdiv's shapes: counts from 0
    text += fmt::format("t corner 1/1/0 {} {:g}\n", corner.v, corner.sharpness);
  return text;
}

std::string heartScene(const HeartFiles& wanted, const Recording& recording,
                       const std::string& mesh_folder) {
  const heart::ProbePose& pose = recording.pose;
  const double hr_bpm = wanted.parameters.heart_rate_bpm;
  constexpr double kMillimetre = 1e-3;
  std::string text = fmt::format(
      R"(# A parametric heart, {}, {:g} beats per minute.
# World axes in mm: origin at the mitral ring at end-diastole, z to the apex of the left ventricle,
# x from the septum to its lateral wall, y to its anterior wall.

background = "soft_tissue"

[probe]
kind = "phased"
apex = {}
axis = {}
lateral = {}
sector_deg = {:g}
min_depth_mm = 2
depth_mm = {:g}
frequency_mhz = 2.5
lines = 256
samples = 1024

[acquisition]
heart_rate_bpm = {:g}
frame_rate_hz = 50
beats = 1

[motion]
mesh_unit = "mm"
subdivision = {}   # the meshes are control meshes of Loop surfaces
keyframe_heart_rate_bpm = {:g}   # another heart_rate_bpm above plays them with a diastole of other length
end_systole_phase = {:.6f}
keyframe_phases = {}

[signal]
dynamic_range_db = 55
reference_intensity = 2e-4   # white, of the transmitted intensity: one gain for all hearts and views

# Where structures overlap the highest priority wins. Cavities pierce walls; the septum belongs to the
# left ventricle and the right heart is wrapped round it.
)",
      meaningOf(wanted.view), hr_bpm, vectorText(pose.apex, kMillimetre), vectorText(pose.axis, 1),
      vectorText(pose.lateral, 1), pose.sector_deg, std::round(pose.depth_m / kMillimetre), hr_bpm,
      Recording::kLevels, hr_bpm, recording.end_systole_phase, listText(recording.phases));
  for (const RecordedPart& part : recording.parts) text += structureText(part, mesh_folder);
  return text;
}

void writeHeart(const HeartFiles& wanted, const fs::path& folder, const Monitor& monitor) {
  if (const std::string fault = heart::faultOf(wanted.parameters); !fault.empty())
    throw SceneError("heart: " + fault);
  FolderInTheMaking making(folder);
  withThreads(wanted.threads, [&] {
    const heart::ParametricHeart model(wanted.parameters);
    const Recording recording =
        heart::record(model, wanted.view, wanted.keyframes, wanted.spacing, monitor);
    for (const RecordedPart& part : recording.parts)
      for (std::size_t k = 0; k < part.control_m.size(); ++k) {
        if (!monitor.keep_going()) throw JobError("stopped");
        writeText(making.path() / heartMeshName(part, k), heartMesh(part, k));
      }
    writeText(making.path() / "truth.json", heart::truthText(model, recording));
    writeText(making.path() / "scene.toml", heartScene(wanted, recording, ""));
  });
  making.finish();
}

}  // namespace echocine
