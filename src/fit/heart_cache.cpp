#include "fit/heart_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <vector>

#include "core/digest.h"
#include "core/error.h"
#include "core/file.h"
#include "fit/packed_bytes.h"

namespace echocine::fit {

namespace {

namespace fs = std::filesystem;

constexpr char kHeartFile[] = "heart_";
constexpr double kMicrometre = 1e-6;

std::vector<std::byte> bytesIn(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

// Points in whole micrometres take half the space: control points are rounded to them.
void putPoints(const std::vector<Vec3d>& points, PackedBytes& out) {
  std::vector<std::int32_t> whole;
  for (const Vec3d& p : points)
    for (const double m : {p.x, p.y, p.z}) {
      const double um = std::round(m / kMicrometre);
      if (!(std::abs(um) < 1e9) || um * kMicrometre != m) {
        out.put(char{0});
        return out.putAll(points);
      }
      whole.push_back(static_cast<std::int32_t>(um));
    }
  out.put(char{1});
  out.putAll(whole);
}

std::vector<Vec3d> pointsFrom(UnpackedBytes& in) {
  if (in.get<char>() == 0) return in.getAll<Vec3d>();
  const std::vector<std::int32_t> whole = in.getAll<std::int32_t>();
  std::vector<Vec3d> out;
  for (std::size_t i = 0; i + 2 < whole.size(); i += 3)
    out.push_back({whole[i] * kMicrometre, whole[i + 1] * kMicrometre, whole[i + 2] * kMicrometre});
  return out;
}

void putPart(const heart::RecordedPart& part, PackedBytes& out) {
  out.putText(part.kind.name);
  out.putText(part.kind.medium);
  out.put(part.kind.priority);
  out.put(part.kind.membrane);
  out.put(part.kind.reflection_exponent);
  out.putAll(part.faces);
  out.putAll(part.tags.edges);
  out.putAll(part.tags.vertices);
  out.put(static_cast<std::uint64_t>(part.control_m.size()));
  for (const std::vector<Vec3d>& points : part.control_m) putPoints(points, out);
  out.putAll(part.volume_m3);
}

heart::RecordedPart partFrom(UnpackedBytes& in) {
  heart::RecordedPart part;
  part.kind.name = in.getText();
  part.kind.medium = in.getText();
  part.kind.priority = in.get<int>();
  part.kind.membrane = in.get<bool>();
  part.kind.reflection_exponent = in.get<double>();
  part.faces = in.getAll<heart::Face>();
  part.tags.edges = in.getAll<SharpEdge>();
  part.tags.vertices = in.getAll<SharpVertex>();
  const auto keyframes = in.get<std::uint64_t>();
  for (std::uint64_t k = 0; in.good() && k < keyframes; ++k)
    part.control_m.push_back(pointsFrom(in));
  part.volume_m3 = in.getAll<double>();
  return part;
}

void putBeat(const heart::Recording& beat, PackedBytes& out) {
  out.put(beat.pose);
  out.putAll(beat.phases);
  out.put(beat.body_scale);
  out.put(beat.end_systole_phase);
  out.put(static_cast<std::uint64_t>(beat.end_systole));
  out.putAll(beat.places);
  out.put(static_cast<std::uint64_t>(beat.parts.size()));
  for (const heart::RecordedPart& part : beat.parts) putPart(part, out);
  out.putAll(beat.sac_reach_m);
}

heart::Recording beatFrom(UnpackedBytes& in) {
  heart::Recording beat;
  beat.pose = in.get<heart::ProbePose>();
  beat.phases = in.getAll<double>();
  beat.body_scale = in.get<double>();
  beat.end_systole_phase = in.get<double>();
  beat.end_systole = static_cast<std::size_t>(in.get<std::uint64_t>());
  beat.places = in.getAll<heart::Landmarks>();
  const auto parts = in.get<std::uint64_t>();
  for (std::uint64_t p = 0; in.good() && p < parts; ++p) beat.parts.push_back(partFrom(in));
  beat.sac_reach_m = in.getAll<double>();
  return beat;
}

// The file whose mapping has this code, by the kernel's list: "low-high flags ... path".
fs::path ownFile() {
  const auto here = reinterpret_cast<std::uintptr_t>(&userHeartCache);
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    std::istringstream words(line);
    std::uintptr_t low = 0, high = 0;
    char dash = 0;
    std::string flags, offset, device, inode, path;
    if (!(words >> std::hex >> low >> dash >> high)) continue;
    if (here < low || here >= high) continue;
    words >> flags >> offset >> device >> inode >> std::ws;
    std::getline(words, path);
    return path;
  }
  return {};
}

}  // namespace

const std::string& ownProgramDigest() {
  static const std::string digest = [] {
    const fs::path file = ownFile();
    const std::vector<std::byte> bytes = file.empty() ? std::vector<std::byte>{} : bytesIn(file);
    return bytes.empty() ? std::string{} : digestOfBytes(bytes);
  }();
  return digest;
}

fs::path userHeartCache() {
  for (const auto& [variable, below] :
       {std::pair{"XDG_CACHE_HOME", "echocine/hearts"}, {"HOME", ".cache/echocine/hearts"}}) {
    const char* folder = std::getenv(variable);
    if (folder != nullptr && fs::path(folder).is_absolute()) return fs::path(folder) / below;
  }
  return {};
}

HeartCache::HeartCache(fs::path folder, std::uintmax_t most_bytes, Warn warn)
    : folder_(std::move(folder)), most_bytes_(most_bytes), warn_(std::move(warn)) {
  if (ownProgramDigest().empty()) folder_.clear();
}

fs::path HeartCache::fileOf(const std::map<std::string, double>& dials, int frames) const {
  if (folder_.empty()) return {};
  PackedBytes key;
  key.putText(ownProgramDigest());
  key.put(frames);
  for (const auto& [dial, value] : dials) {
    key.putText(dial);
    key.put(value);
  }
  return folder_ / fmt::format("{}{}.bin", kHeartFile, digestOfBytes(key.all()));
}

std::optional<heart::Recording> HeartCache::find(const std::map<std::string, double>& dials,
                                                 int frames) const {
  const fs::path file = fileOf(dials, frames);
  std::error_code error;
  if (file.empty() || !fs::is_regular_file(file, error)) return std::nullopt;
  const std::vector<std::byte> bytes = bytesIn(file);
  if (bytes.size() < Digest::kDigits) return std::nullopt;
  const auto content = std::span(bytes).first(bytes.size() - Digest::kDigits);
  const std::string digest = digestOfBytes(content);
  if (std::memcmp(digest.data(), bytes.data() + content.size(), Digest::kDigits) != 0)
    return std::nullopt;
  UnpackedBytes in(content);
  heart::Recording beat = beatFrom(in);
  if (!in.atEnd()) return std::nullopt;
  fs::last_write_time(file, fs::file_time_type::clock::now(), error);
  return beat;
}

void HeartCache::keep(const std::map<std::string, double>& dials, int frames,
                      const heart::Recording& beat) {
  const fs::path file = fileOf(dials, frames);
  if (file.empty()) return;
  PackedBytes out;
  putBeat(beat, out);
  const std::string digest = digestOfBytes(out.all());
  try {
    makeFolder(folder_);
    WholeFile whole(file);
    whole.write(out.all());
    whole.write(std::as_bytes(std::span(digest)));
    whole.finish();
  } catch (const JobError& failed) {
    warn_(fmt::format("hearts are not kept: {}", failed.what()));
    folder_.clear();
  }
}

void HeartCache::prune() const {
  if (folder_.empty()) return;
  struct Kept {
    fs::file_time_type used;
    fs::path file;
    std::uintmax_t bytes;
  };
  std::vector<Kept> files;
  std::uintmax_t sum = 0;
  std::error_code error;
  const auto now = fs::file_time_type::clock::now();
  for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    std::error_code gone;  // another process may have removed it
    if (!name.starts_with(kHeartFile) || !at->is_regular_file(gone)) continue;
    const auto used = fs::last_write_time(at->path(), gone);
    const std::uintmax_t bytes = gone ? 0 : fs::file_size(at->path(), gone);
    if (gone) continue;
    // A part of a run that was killed: no run writes a file for so long.
    if (!targetOfPart(name).empty()) {
      if (now - used > std::chrono::hours(1)) fs::remove(at->path(), gone);
      continue;
    }
    files.push_back({used, at->path(), bytes});
    sum += bytes;
  }
  std::sort(files.begin(), files.end(),
            [](const Kept& a, const Kept& b) { return a.used < b.used; });
  for (const Kept& one : files) {
    if (sum <= most_bytes_) break;
    fs::remove(one.file, error);
    sum -= one.bytes;
  }
}

}  // namespace echocine::fit
