#include "output/heart_files.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/folder_lock.h"
#include "core/parallel.h"
#include "motion/heart/heart_scene.h"
#include "motion/heart/heart_truth.h"
#include "motion/heart/recording.h"
#include "output/npy.h"

namespace echocine {

namespace {

namespace fs = std::filesystem;
using heart::RecordedPart;
using heart::Recording;

// Rounded to a micrometre. Never -0.
double millimetres(double metres) {
  return std::round(metres * 1e6) / 1e3 + 0.0;
}

// Three decimals, as of millimetres(): exact in whole micrometres, which a heart's sizes are.
void appendMillimetres(std::string& text, double metres) {
  const auto micrometres = static_cast<std::int64_t>(std::round(metres * 1e6));
  char digits[32];
  char* to = digits;
  *to++ = ' ';
  if (micrometres < 0) *to++ = '-';
  const std::int64_t size = std::abs(micrometres), fraction = size % 1000;
  to = std::to_chars(to, digits + sizeof digits, size / 1000).ptr;
  *to++ = '.';
  for (const std::int64_t place : {100, 10, 1})
    *to++ = static_cast<char>('0' + fraction / place % 10);
  text.append(digits, to);
}

// The lines of faces and corners, the same in all keyframes.
std::string facesText(const RecordedPart& part) {
  std::string text;
  for (const heart::Face& face : part.faces) {
    text += 'f';
    for (const auto vertex : face) text += ' ' + std::to_string(vertex + 1);  // OBJ counts from 1
    text += '\n';
  }
  for (const SharpVertex& corner : part.tags.vertices)  // as OpenSubdiv's shapes: counts from 0
    text += fmt::format("t corner 1/1/0 {} {:g}\n", corner.v, corner.sharpness);
  return text;
}

std::string meshText(const RecordedPart& part, std::size_t keyframe, const std::string& faces) {
  constexpr std::size_t kLine = 28;  // of most vertices
  std::string text;
  text.reserve(kLine * part.control_m[keyframe].size() + faces.size());
  for (const Vec3d point : part.control_m[keyframe]) {
    text += 'v';
    for (const double metres : {point.x, point.y, point.z}) appendMillimetres(text, metres);
    text += '\n';
  }
  return text += faces;
}

void writeText(const fs::path& file, const std::string& text) {
  writeNewFile(file, std::as_bytes(std::span(text)));
}

// All keyframes of a part. Texts are made on all threads, files are written in order.
void writePart(const fs::path& folder, const RecordedPart& part) {
  const std::string faces = facesText(part);
  std::vector<std::string> texts(part.control_m.size());
  parallelBlocks(texts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) texts[k] = meshText(part, k, faces);
  });
  for (std::size_t k = 0; k < texts.size(); ++k)
    writeText(folder / heart::meshName(part, k), texts[k]);
}

// Files are made on all threads, and written in order.
void writeNpz(const fs::path& folder, const std::vector<RecordedPart>& parts) {
  std::vector<std::vector<std::byte>> files(parts.size());
  parallelBlocks(parts.size(), 1,
                 [&](std::size_t i, std::size_t) { files[i] = heartNpz(parts[i]); });
  for (std::size_t i = 0; i < parts.size(); ++i)
    writeNewFile(folder / (parts[i].kind.name + std::string(".npz")), files[i]);
}

// A folder beside the target, removed unless it replaces the target. The next run removes what a
// killed run left of it.
class FolderInTheMaking {
 public:
  explicit FolderInTheMaking(const fs::path& folder) {
    std::error_code failed;
    if (fs::exists(folder, failed)) {
      if (!(fs::is_directory(folder, failed) && fs::is_empty(folder, failed)))
        throw JobError(
            fmt::format("{}: is not empty; give a new folder, so that keyframes of another heart "
                        "are not mixed in",
                        folder.string()));
      folder_ = fs::canonical(folder, failed);
    } else {
      const fs::path full = fs::absolute(folder).lexically_normal();
      folder_ = full.has_filename() ? full : full.parent_path();
    }
    const fs::path part = folder_.string() + ".echocine-part";
    fs::create_directories(part, failed);
    if (failed)
      throw JobError(fmt::format("{}: cannot be created: {}", folder.string(), failed.message()));
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
  // The files reach the disk before the folder's name does, so that no power loss leaves a heart
  // with half a mesh.
  void finish() {
    syncAllOf(part_);
    std::error_code failed;
    fs::rename(part_, folder_, failed);  // an empty folder makes way
    if (failed)
      throw JobError(fmt::format("{}: cannot be created: {}", folder_.string(), failed.message()));
    part_.clear();
    syncFolderOf(folder_);
  }

 private:
  fs::path folder_, part_;
  std::optional<FolderLock> lock_;
};

}  // namespace

std::string heartMesh(const RecordedPart& part, std::size_t keyframe) {
  return meshText(part, keyframe, facesText(part));
}

std::vector<std::byte> heartNpz(const RecordedPart& part) {
  const std::size_t keyframes = part.control_m.size(), vertices = part.control_m.front().size();
  std::vector<double> points;
  points.reserve(3 * keyframes * vertices);
  for (const std::vector<Vec3d>& keyframe : part.control_m)
    for (const Vec3d& p : keyframe)
      points.insert(points.end(), {millimetres(p.x), millimetres(p.y), millimetres(p.z)});
  std::vector<std::int32_t> faces, corners;
  std::vector<float> sharpness;
  for (const heart::Face& face : part.faces)
    for (const auto vertex : face) faces.push_back(static_cast<std::int32_t>(vertex));
  for (const SharpVertex& corner : part.tags.vertices) {
    corners.push_back(static_cast<std::int32_t>(corner.v));
    sharpness.push_back(corner.sharpness);
  }
  std::vector<NamedArray> arrays{{"points", npyBytes(points, {keyframes, vertices, 3})},
                                 {"faces", npyBytes(faces, {part.faces.size(), 3})}};
  if (!corners.empty()) {
    arrays.push_back({"corners", npyBytes(corners, {corners.size()})});
    arrays.push_back({"corner_sharpness", npyBytes(sharpness, {sharpness.size()})});
  }
  return npzBytes(arrays);
}

void writeHeart(const HeartFiles& wanted, const fs::path& folder, const Monitor& monitor) {
  if (const std::string fault = heart::faultOf(wanted.parameters); !fault.empty())
    throw SceneError("heart: " + fault);
  FolderInTheMaking making(folder);
  withThreads(wanted.threads, [&] {
    const heart::ParametricHeart model(wanted.parameters);
    const Recording recording =
        heart::record(model, wanted.view, wanted.keyframes, wanted.spacing, monitor);
    if (wanted.format == heart::MeshFormat::npz) {
      writeNpz(making.path(), recording.parts);
    } else {
      for (const RecordedPart& part : recording.parts) {
        if (!monitor.keep_going()) throw JobError("stopped");
        writePart(making.path(), part);
      }
    }
    writeText(making.path() / "truth.json", heart::truthText(model, recording));
    writeText(making.path() / "scene.toml",
              heart::sceneText(wanted.view, wanted.parameters, recording, "", wanted.look,
                               wanted.format));
  });
  making.finish();
}

}  // namespace echocine
