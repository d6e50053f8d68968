// Archives in beam space as loops to compare with: the shipped heart comes back, and files that are
// wrong are refused.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "archive/echoxflow.h"
#include "archive/zea_file.h"
#include "compare/compare.h"
#include "core/error.h"
#include "echo/beam_recording.h"
#include "hdf/hdf5_file.h"
#include "scene/scan_geometry.h"
#include "signal/scan_conversion.h"
#include "support/all_cases.h"
#include "support/beam_loops.h"
#include "support/damaged_file.h"
#include "support/paths.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
using Json = nlohmann::json;
namespace fs = std::filesystem;

// The error message of reading a path; empty if it is read.
std::string readingErrorOf(const fs::path& path) {
  try {
    echo::readLoop(path, {}, true);
  } catch (const SceneError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "";
}

void expectReadingError(const fs::path& path, const std::string& part) {
  const std::string error = readingErrorOf(path);
  EXPECT_NE(error.find(part), std::string::npos) << part << ": " << error;
}

// Both archives of one loop.
struct Archives {
  explicit Archives(const BeamLoop& loop) {
    writeEchoXFlow(loop, folder / "root", "exam", "loop");
    writeZea(loop, folder / "loop.hdf5", "exam");
  }
  TempFolder folder;
  fs::path zarr = folder / "root/exam/loop.zarr", zea = folder / "loop.hdf5";
  std::vector<fs::path> both() const { return {zarr, zea}; }
};

TEST(BeamRecording, GreysGeometryAndTimesComeBack) {
  const BeamLoop loop = smallBeamLoop();
  const Archives archives(loop);
  const Probe& probe = loop.scene.probe;
  const std::vector<std::uint8_t> bytes = bytesOfGreys(loop);
  for (const fs::path& path : archives.both()) {
    SCOPED_TRACE(path.filename().string());
    const echo::EchoLoop read = echo::readLoop(path, {}, true);
    EXPECT_EQ(read.scale_source, "recording");
    EXPECT_NEAR(read.video.rate.hz, 20, 2e-6);
    EXPECT_TRUE(read.video.rate.trusted);
    const echo::TracedGreys& t = read.traced;
    ASSERT_EQ(t.lines, probe.lines);
    ASSERT_EQ(t.samples, probe.samples);
    EXPECT_NEAR(t.first_rad, probe.first_angle_rad, 1e-7);
    EXPECT_NEAR(t.last_rad, probe.last_angle_rad, 1e-7);
    EXPECT_NEAR(t.near_m, probe.min_depth_m, 1e-8);
    EXPECT_NEAR(t.far_m, probe.max_depth_m, 1e-8);
    ASSERT_EQ(t.frames.size(), static_cast<std::size_t>(loop.frames));
    std::size_t at = 0;
    for (const std::vector<float>& frame : t.frames)
      for (int k = 0; k < t.samples; ++k)
        for (int i = 0; i < t.lines; ++i)
          ASSERT_EQ(frame[static_cast<std::size_t>(i * t.samples + k)], bytes[at++]);
    // Beats of 0.8 s: the waves within the loop, and the rate.
    ASSERT_EQ(read.video.r_waves_s.size(), 3u);
    for (std::size_t n = 0; n < 3; ++n)
      EXPECT_NEAR(read.video.r_waves_s[n], 0.8 * static_cast<double>(n), 3e-4);
    EXPECT_NEAR(*read.video.heart_rate_bpm, 75, 0.02);
    EXPECT_EQ(read.beat_anchor, "ECG of the recording");
  }
}

// The picture against the interpolation in beam space, and black outside the sector.
TEST(BeamRecording, ThePictureIsTheSectorOfTheSamples) {
  const BeamLoop loop = smallBeamLoop(4);
  const Archives archives(loop);
  const ScanGeometry geometry(loop.scene.probe);
  for (const fs::path& path : archives.both()) {
    const echo::EchoLoop read = echo::readLoop(path, {}, true);
    const echo::Sector& s = read.sector();
    EXPECT_DOUBLE_EQ(*read.metres_per_pixel, echo::kRecordingPixel_m);
    int inside = 0;
    for (int y = 0; y < read.video.height; ++y)
      for (int x = 0; x < read.video.width; ++x) {
        const int grey = read.video.frames[1][static_cast<std::size_t>(y * read.video.width + x)];
        const double dx = x + 0.5 - s.apex_x, dy = y + 0.5 - s.apex_y;
        const double depth = std::hypot(dx, dy) * echo::kRecordingPixel_m,
                     angle = std::atan2(dx, dy);
        const double edge = std::min({std::abs(depth - 0.004), std::abs(depth - 0.084)});
        if (!s.contains(x + 0.5, y + 0.5)) {
          if (edge > 1e-6) {
            EXPECT_EQ(grey, 0) << x << " " << y;
          }
          continue;
        }
        EXPECT_GT(grey, 0) << x << " " << y;
        ++inside;
        const double line = (angle - s.first_rad) / geometry.cellWidth(),
                     sample = std::clamp((depth - 0.004) / 0.002 - 0.5, 0.0, 39.0);
        const double i = std::clamp(std::floor(line), 0.0, 21.0),
                     k = std::min(std::floor(sample), 38.0);
        const auto at = [&](double u, double v) {
          return static_cast<double>(read.traced.frames[1][static_cast<std::size_t>(u) * 40 +
                                                           static_cast<std::size_t>(v)]);
        };
        const double a = line - i, b = sample - k;
        const double wanted = (1 - a) * ((1 - b) * at(i, k) + b * at(i, k + 1)) +
                              a * ((1 - b) * at(i + 1, k) + b * at(i + 1, k + 1));
        EXPECT_NEAR(grey, wanted, 0.52);
      }
    // The area of the sector, by its formula.
    const double area = 0.5 * (s.last_rad - s.first_rad) * (s.r_max * s.r_max - s.r_min * s.r_min);
    EXPECT_NEAR(inside, area, 0.01 * area);
  }
}

// The shipped heart: a render against its own archives.
TEST(BeamRecording, AnArchiveOfTheShippedHeartIsItsRender) {
  const TempFolder folder;
  const fs::path file = fs::path(kSourceDir) / "examples/beating_heart/scene.toml";
  std::string text = bytesOf(file);
  text = std::regex_replace(text, std::regex("\\.\\./\\.\\./data"),
                            (fs::path(kSourceDir) / "data").string());
  for (const auto& [key, value] :
       {std::pair("lines", "48"), std::pair("samples", "160"), std::pair("frame_rate_hz", "13")})
    text = std::regex_replace(text, std::regex(std::string("\\n") + key + " = [^\\n]*"),
                              std::string("\n") + key + " = " + value);
  folder.write("scene.toml",
               text + "\n[output]\nchannels = [\"display.Y\"]\nwidth = 400\nheight = 300\n");
  const auto run = [&](const std::string& line) {
    const Outcome o = runShell("cd '" + folder.path().string() + "' && %B " + line + " --quiet");
    ASSERT_EQ(o.code, 0) << o.err;
  };
  run("render scene.toml -o loop");
  run("archive scene.toml -o root --layout echoxflow --exam exam --recording loop");
  run("archive scene.toml -o loop.hdf5 --layout zea");
  for (const std::string path : {"root/exam/loop.zarr", "loop.hdf5"}) {
    SCOPED_TRACE(path);
    compare::CompareOptions options;
    options.synthetic = folder / "loop";
    options.real = folder / path;
    const compare::Comparison c = compare::compareLoops(options, {});
    EXPECT_LT(c.discrepancy, 3e-5);
    EXPECT_EQ(c.time.shift_frames, 0);
    EXPECT_NEAR(c.real.video.rate.hz, 13, 1e-5);
    // One beat at 65 a minute: its R wave is the first frame.
    ASSERT_EQ(c.real.video.r_waves_s.size(), 1u);
    EXPECT_NEAR(c.real.video.r_waves_s[0], 0, 2e-4);
    EXPECT_NEAR(*c.real.video.heart_rate_bpm, 65, 0.01);
    EXPECT_NEAR(c.real_beat.frames, 13 * 60.0 / 65, 0.003);
    const echo::TracedGreys &a = c.synthetic.traced, &b = c.real.traced;
    EXPECT_NEAR(a.near_m, b.near_m, 1e-7);
    EXPECT_NEAR(a.far_m, b.far_m, 1e-7);
    EXPECT_NEAR(a.first_rad, b.first_rad, 1e-6);
    EXPECT_NEAR(a.last_rad, b.last_rad, 1e-6);
    ASSERT_EQ(a.frames.size(), b.frames.size());
    for (std::size_t f = 0; f < a.frames.size(); ++f)
      for (std::size_t i = 0; i < a.frames[f].size(); ++i)
        ASSERT_NEAR(a.frames[f][i], b.frames[f][i], 0.5001);
  }
}

TEST(BeamRecording, AManifestThatIsNoSectorIsRefused) {
  const Archives archives(smallBeamLoop(4));
  const fs::path file = archives.zarr / ".zattrs";
  const Json whole = Json::parse(bytesOf(file));
  const auto refused = [&](const char* pointer, const Json& value, const std::string& part) {
    Json changed = whole;
    const Json::json_pointer at(std::string("/recording_manifest") + pointer);
    if (value.is_discarded())
      changed[at.parent_pointer()].erase(at.back());
    else
      changed[at] = value;
    writeBytes(file, changed.dump());
    expectReadingError(archives.zarr, part);
    writeBytes(file, whole.dump());
  };
  const Json absent(Json::value_t::discarded);
  refused("/sectors", absent, "sectors is absent");
  refused("/sectors", 3, "no sector \"bmode\"");
  refused("/sectors/0/geometry", absent, "geometry is absent");
  refused("/sectors/0/geometry/depth_start_m", absent, "depth_start_m is absent");
  refused("/sectors/0/geometry/depth_start_m", "far", "depth_start_m is no number");
  refused("/sectors/0/geometry/depth_start_m", 0.2, "its samples run from");
  refused("/sectors/0/geometry/depth_end_m", 1e300, "its samples run from");
  refused("/sectors/0/geometry/angle_end_rad", -2, "its lines run from");
  refused("/sectors/0/frames/array_path", "../exam/loop.zarr/data/2d_brightness_mode",
          "outside it");
  refused("/sectors/0/frames/array_path", "data/ecg", "axes, accepted");
  refused("/sectors/0/frames/array_path", "data/tissue_doppler", "holds no bytes");
  refused("/sectors/0/frames/array_path", "data/nothing", "is absent");
  refused("/sectors/0/timestamps/array_path", "timestamps/ecg", "accepted: up to 4");
  EXPECT_EQ(readingErrorOf(archives.zarr), "");
  // Readers of the layout find B-mode by its array too, and times by the usual name.
  Json sparse = whole;
  Json& sector = sparse["recording_manifest"]["sectors"][0];
  sector["semantic_id"] = "else";
  sector.erase("timestamps");
  writeBytes(file, sparse.dump());
  EXPECT_NEAR(echo::readLoop(archives.zarr, {}, true).video.rate.hz, 20, 1e-5);
  fs::remove_all(archives.zarr / "timestamps/2d_brightness_mode");
  EXPECT_EQ(echo::readLoop(archives.zarr, {}, true).video.rate.hz, 0);
  sector["frames"]["array_path"] = "data/tissue_doppler";
  writeBytes(file, sparse.dump());
  expectReadingError(archives.zarr, "no sector \"bmode\"");
  writeBytes(file, whole.dump());
  expectReadingError(archives.folder / "root", "is a catalogue of recordings");
  writeBytes(archives.folder / "packed.zarr", "PK");
  expectReadingError(archives.folder / "packed.zarr", "is a packed store");
  fs::remove(archives.zarr / ".zgroup");
  expectReadingError(archives.zarr, ".zgroup");
}

TEST(BeamRecording, FilesThatAreNoSectorOfZeaAreRefused) {
  const TempFolder folder;
  const std::string image = "tracks/track_0/data/image/";
  const std::vector<std::uint8_t> greys(3 * 4 * 5, 7);
  std::vector<float> flat;
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < 5; ++i)
      for (const float along : {0.01f * static_cast<float>(i), 0.0f, 0.01f * static_cast<float>(k)})
        flat.push_back(along);
  const Hdf5Array values{image + "values", {3, 4, 5}, std::span<const std::uint8_t>(greys)},
      places{image + "coordinates", {4, 5, 3}, std::span<const float>(flat)};
  const auto refused = [&](const std::vector<Hdf5Array>& arrays, bool version, const char* part) {
    const Hdf5Attribute zea{"zea_version", "0.1.0"};
    const std::vector<std::byte> bytes = hdf5Bytes(arrays, std::span(&zea, version ? 1u : 0u));
    writeBytes(folder / "file.hdf5", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    expectReadingError(folder / "file.hdf5", part);
  };
  refused({values, places}, false, "no attribute zea_version");
  refused({places}, true, "has no image");
  refused({values}, true, "no coordinates of shape 4, 5, 3");
  refused({values, {image + "coordinates", {5, 4, 3}, std::span<const float>(flat)}}, true,
          "no coordinates of shape");
  refused({values, places}, true, "are no sector");  // a plane of parallel lines
  refused({{image + "values", {60}, std::span<const std::uint8_t>(greys)}, places}, true, "1 axes");
  refused({{image + "values", {}, std::string("grey")}, places}, true, "axes");
  refused({values, {image + "coordinates", {}, std::string("there")}}, true, "no coordinates");
  std::vector<float> nan = flat;
  nan[7] = NAN;
  refused({values, {image + "coordinates", {4, 5, 3}, std::span<const float>(nan)}}, true,
          "are no sector");
  writeBytes(folder / "text.hdf5", "not HDF5");
  expectReadingError(folder / "text.hdf5", "no HDF5 file");
}

// Every damage ends in one line, or in a loop of the same shape. No child process is left.
TEST(BeamRecording, DamagedFilesEndInOneLine) {
  const Archives archives(smallBeamLoop(4));
  std::vector<fs::path> files{archives.zea};
  for (const auto& entry : fs::recursive_directory_iterator(archives.zarr))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  int refused = 0;
  for (const fs::path& file : files) {
    const bool zea = file == archives.zea;
    const std::string whole = bytesOf(file);
    for (std::uint64_t seed = 0; seed < (zea ? 80 : 3) * (allCases() ? 3u : 1u); ++seed) {
      SCOPED_TRACE(fmt::format("{} {}", file.filename().string(), seed));
      writeBytes(file, damaged(whole, seed));
      try {
        const echo::EchoLoop read = echo::readLoop(zea ? archives.zea : archives.zarr, {}, true);
        for (const std::vector<float>& frame : read.traced.frames)
          EXPECT_EQ(std::ssize(frame), read.traced.lines * read.traced.samples);
      } catch (const SceneError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        ++refused;
      }
    }
    writeBytes(file, whole);
  }
  EXPECT_GT(refused, 40);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  for (const fs::path& path : archives.both()) EXPECT_EQ(readingErrorOf(path), "");
}

}  // namespace
}  // namespace echocine
