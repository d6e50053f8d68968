// The loop as DICOM: read back by our reader, by pydicom and by GDCM, and checked by dciodvfy.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <tuple>

#include "core/hash.h"
#include "echo/beat_length.h"
#include "echo/read_loop.h"
#include "motion/surfaces/probe_placement.h"
#include "render/render.h"
#include "support/loop_scene.h"
#include "support/run_files.h"
#include "support/run_program.h"
#include "support/video_difference.h"
#include "video/dicom_uid.h"
#include "video/dicom_writer.h"
#include "video/read_video.h"

namespace echocine {
namespace {

using namespace support;

class DicomLoopFile : public ::testing::Test {
 protected:
  // Two beats of 24 frames, one a second and a half long.
  static SceneText dicomScene(const std::string& codec = "mjpg") {
    SceneText text = ballScene(16);
    text.acquisition["heart_rate_bpm"] = "40";
    text.acquisition["beats"] = "2";
    text.output["dicom"] = "true";
    text.output["codec"] = "\"" + codec + "\"";
    return text;
  }
  Scene render(const SceneText& text, const std::string& out,
               std::optional<std::pair<int, int>> frames = {}) const {
    const Scene scene = readScene(writeBall(folder, text));
    renderLoop(scene, {.folder = folder / out, .threads = 1, .frames = frames}, {});
    return placed(scene);
  }
  std::string quoted(const std::string& name) const {
    return " '" + (folder / name).string() + "'";
  }

  TempFolder folder;
};

// Both codecs: JPEG baseline beside MJPG, plain RGB beside FFV1.
TEST_F(DicomLoopFile, HoldsTheGreysRateScaleAndRWavesOfTheLoop) {
  for (const std::string codec : {"mjpg", "ffv1"}) {
    const Scene scene = render(dicomScene(codec), codec);
    const Video avi = readVideo(folder / codec / "cine.avi");
    const Video dicom = readVideo(folder / codec / "cine.dcm");
    // Decoders of JPEG round differently.
    EXPECT_LE(worstDifference(dicom, avi), codec == "ffv1" ? 0 : 1) << codec;
    EXPECT_EQ(dicom.frameCount(), 48);
    EXPECT_EQ(dicom.rate.source, "DICOM FrameTime");
    EXPECT_DOUBLE_EQ(dicom.rate.hz, 16);
    EXPECT_TRUE(dicom.rate.trusted);
    EXPECT_EQ(dicom.heart_rate_bpm, 40);
    EXPECT_EQ(dicom.r_waves_s, (std::vector<double>{0, 1.5}));
    ASSERT_EQ(dicom.regions.size(), 1u);
    const PictureGeometry g = pictureGeometry(scene);
    const UltrasoundRegion& region = dicom.regions[0];
    EXPECT_DOUBLE_EQ(region.cm_per_pixel_x, 100 * g.metres_per_pixel);
    EXPECT_DOUBLE_EQ(region.cm_per_pixel_y, 100 * g.metres_per_pixel);
    // The box of a sector of 70 degrees, 2 to 120 mm deep.
    const double half_px = 0.12 * std::sin(35 * std::numbers::pi / 180) / g.metres_per_pixel;
    EXPECT_NEAR(region.min_x, g.origin_x_px - half_px, 1);
    EXPECT_NEAR(region.max_x, g.origin_x_px + half_px, 1);
    EXPECT_NEAR(region.max_y, g.origin_y_px + 0.12 / g.metres_per_pixel, 1);
    EXPECT_NEAR(region.min_y,
                g.origin_y_px + 0.002 * std::cos(35 * std::numbers::pi / 180) / g.metres_per_pixel,
                1);
  }
}

TEST_F(DicomLoopFile, IsALoopOfItsOwnForTheComparison) {
  render(dicomScene(), "loop");
  const echo::EchoLoop loop = echo::readLoop(folder / "loop/cine.dcm", {}, true);
  EXPECT_EQ(loop.scale_source, "DICOM regions");
  EXPECT_EQ(loop.beat_anchor, "DICOM R waves");
  const Scene scene = placed(readScene(folder / "scene.toml"));
  const PictureGeometry g = pictureGeometry(scene);
  EXPECT_DOUBLE_EQ(loop.metres_per_pixel.value_or(0), g.metres_per_pixel);
  const std::string sector = fmt::format("{},{},-35,35,{},{}", g.origin_x_px, g.origin_y_px,
                                         2e-3 / g.metres_per_pixel, 0.12 / g.metres_per_pixel);
  const Outcome o = runShell("%B compare" + quoted("loop") + quoted("loop/cine.dcm") + " -o" +
                             quoted("out") + " --quiet --sector=" + sector);
  ASSERT_EQ(o.code, 0) << o.err;
  const nlohmann::json summary = nlohmann::json::parse(bytesOf(folder / "out/summary.json"));
  EXPECT_LT(summary.at("discrepancy").get<double>(), 1e-4);
  EXPECT_EQ(summary.at("time").at("shift_frames").get<double>(), 0);
}

// The user's word comes before the file's, except where a render states its geometry.
TEST_F(DicomLoopFile, OptionsOverrideItsTags) {
  const double metres_per_pixel = pictureGeometry(render(dicomScene(), "loop")).metres_per_pixel;
  const auto file = folder / "loop/cine.dcm";
  echo::SideOptions side;
  side.heart_rate_bpm = 90;
  const echo::EchoLoop faster = echo::readLoop(file, side, true);
  EXPECT_NEAR(echo::beatOf(faster).frames, 16 * 60 / 90.0, 1e-9);
  EXPECT_EQ(echo::beatOf(faster).source, "--heart-rate");
  side = {};
  side.pixel_aspect = 1.25;  // the tags belong to the pixels before the stretch
  const echo::EchoLoop stretched = echo::readLoop(file, side, true);
  EXPECT_EQ(stretched.scale_source, "DICOM regions");
  EXPECT_NEAR(stretched.metres_per_pixel.value_or(0), metres_per_pixel / std::sqrt(1.25), 1e-9);
  for (const bool scale : {true, false}) {
    side = {};
    if (scale) side.mm_per_pixel = 0.3;
    if (!scale) side.pixel_aspect = 1.1;
    EXPECT_THROW(echo::readLoop(folder / "loop", side, false), SceneError);
  }
}

// R waves count from the first frame of the file, and those before it are not in the file.
TEST_F(DicomLoopFile, APartOfALoopHasItsOwnRWavesAndIdentifier) {
  render(dicomScene(), "whole");
  render(dicomScene(), "part", std::pair(20, 30));
  const Video part = readVideo(folder / "part/cine.dcm");
  EXPECT_EQ(part.frameCount(), 10);
  ASSERT_EQ(part.r_waves_s.size(), 1u);
  EXPECT_NEAR(part.r_waves_s[0], 4.0 / 16, 1e-7);
  EXPECT_NE(dicomUid("a 20 10"), dicomUid("a 0 48"));
}

// The number is a UUID of version 8 with the text's digest around its fixed bits.
TEST_F(DicomLoopFile, IdentifiersAreNumbersOfTheirText) {
  std::set<std::string> all;
  for (const std::string text : {"a", "b", "study 0", "study 1", ""}) {
    const std::string uid = dicomUid(text), hex = sha256Hex(std::as_bytes(std::span(text)));
    ASSERT_TRUE(uid.starts_with("2.25.")) << uid;
    EXPECT_LE(uid.size(), 44u);
    EXPECT_NE(uid[5], '0');
    std::array<unsigned, 16> bytes{};
    for (const char digit : uid.substr(5)) {
      unsigned carry = static_cast<unsigned>(digit - '0');
      for (std::size_t i = bytes.size(); i-- > 0;) {
        carry += 10 * bytes[i];
        bytes[i] = carry & 0xff;
        carry >>= 8;
      }
      ASSERT_EQ(carry, 0u);
    }
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      const auto digest = static_cast<unsigned>(std::stoul(hex.substr(2 * i, 2), nullptr, 16));
      const unsigned kept = i == 6 ? 0x0f : i == 8 ? 0x3f : 0xff;
      EXPECT_EQ(bytes[i] & kept, digest & kept) << i;
    }
    EXPECT_EQ(bytes[6] >> 4, 8u);
    EXPECT_EQ(bytes[8] >> 6, 2u);
    all.insert(uid);
  }
  EXPECT_EQ(all.size(), 5u);
}

TEST_F(DicomLoopFile, NamesNoFileOfTheRun) {
  render(dicomScene(), "secretplace");
  const std::string bytes = bytesOf(folder / "secretplace/cine.dcm");
  for (const std::string& word :
       {std::string("secretplace"), std::string("scene.toml"), (folder / "").string()})
    EXPECT_EQ(bytes.find(word), std::string::npos) << word;
}

TEST_F(DicomLoopFile, PlainPixelsOfFourGigabytesAreRefusedBeforeARun) {
  OutputSettings output;
  output.dicom = true;
  output.codec = CineCodec::ffv1;
  output.width = output.height = 16384;
  EXPECT_NO_THROW(refuseLargeDicom(output, 5));
  EXPECT_THROW(refuseLargeDicom(output, 6), SceneError);
  output.codec = CineCodec::mjpg;
  EXPECT_NO_THROW(refuseLargeDicom(output, 6));
}

// The option asks for what the key does.
TEST_F(DicomLoopFile, TheOptionAndTheKeyWriteTheSameFile) {
  SceneText text = dicomScene();
  writeBall(folder, text);
  ASSERT_EQ(renderScene(folder / "scene.toml", folder / "key", "--frames :2").code, 0);
  text.output.erase("dicom");
  writeBall(folder, text);
  ASSERT_EQ(renderScene(folder / "scene.toml", folder / "option", "--frames :2 --dicom").code, 0);
  EXPECT_EQ(lastingFiles(folder / "key"), lastingFiles(folder / "option"));
  ASSERT_EQ(renderScene(folder / "scene.toml", folder / "none", "--frames :2").code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "none/cine.dcm"));
}

class DicomViews : public DicomLoopFile {};

// dicom3tools has the rules of the standard for this kind of object. The codes are those of context
// group 12226 (PS3.16), which includes 12343.
TEST_F(DicomViews, StandardViewsPassTheValidatorAndAreCoded) {
  if (runShell("command -v dciodvfy").code != 0) GTEST_SKIP() << "no dciodvfy";
  ASSERT_EQ(runShell("%B heart -o" + quoted("heart")).code, 0);
  const std::string heart = bytesOf(folder / "heart/scene.toml");
  const std::size_t probe = heart.find("[probe]"), after = heart.find("[acquisition]");
  for (const auto& [view, code, codec] :
       {std::tuple{"a4c", "399214001", "mjpg"}, std::tuple{"a2c", "399232001", "mjpg"},
        std::tuple{"plax", "399139001", "mjpg"}, std::tuple{"tee-4c", "131100", "mjpg"},
        std::tuple{"plax", "399139001", "ffv1"}}) {
    const std::string name = std::string(view) + codec;
    folder.write("heart/" + name + ".toml",
                 heart.substr(0, probe) + "[probe]\nkind = \"phased\"\nview = \"" + view +
                     "\"\nlines = 64\nsamples = 256\n[output]\ncodec = \"" + codec + "\"\n" +
                     heart.substr(after));
    const Outcome run = renderScene(folder / "heart" / (name + ".toml"), folder / name,
                                    "--dicom --frames :2 --threads 1");
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_NE(bytesOf(folder / name / "cine.dcm").find(code), std::string::npos) << name;
    const Outcome o = runShell("dciodvfy" + quoted(name + "/cine.dcm") + " 2>&1");
    EXPECT_EQ(o.out.find("Error"), std::string::npos) << name << '\n' << o.out;
    EXPECT_NE(o.out.find("USMultiFrameImage"), std::string::npos) << o.out;
  }
}

TEST_F(DicomLoopFile, PydicomReadsTheTagsOfTheLoop) {
  if (runShell("/usr/bin/python3 -c 'import pydicom, numpy'").code != 0)
    GTEST_SKIP() << "no pydicom";
  render(dicomScene("ffv1"), "loop");
  folder.write("read.py", R"(
import sys, pydicom
d = pydicom.dcmread(sys.argv[1])
p = d.pixel_array
assert p.shape == (48, 120, 160, 3), p.shape
assert (p[..., 0] == p[..., 1]).all() and (p[..., 0] == p[..., 2]).all() and p.max() > 100
assert d.SOPClassUID.name == 'Ultrasound Multi-frame Image Storage'
assert d.FrameIncrementPointer == 0x00181063
assert d.FrameTime == 62.5 and d.CineRate == 16 and d.RecommendedDisplayFrameRate == 16
assert d.HeartRate == 40 and list(d.RWaveTimeVector) == [0, 1500]
assert d.UltrasoundColorDataPresent == 0 and d.Modality == 'US'
r, = d.SequenceOfUltrasoundRegions
assert (r.RegionSpatialFormat, r.RegionDataType) == (1, 1)
assert (r.PhysicalUnitsXDirection, r.PhysicalUnitsYDirection) == (3, 3)
assert r.PhysicalDeltaX == r.PhysicalDeltaY > 0 and r.TransducerFrequency == 2500
assert abs(float(d.PixelSpacing[0]) - 10 * r.PhysicalDeltaX) < 1e-9
# The deepest sample, 120 mm from the face, lies on the region's lower edge.
y = (r.RegionLocationMaxY1 - r.RegionLocationMinY0 - r.ReferencePixelY0) * r.PhysicalDeltaY
y += r.ReferencePixelPhysicalValueY
assert abs(y - 12) <= r.PhysicalDeltaY, y
x = r.ReferencePixelPhysicalValueX - r.ReferencePixelX0 * r.PhysicalDeltaX
w = (r.RegionLocationMaxX1 - r.RegionLocationMinX0) * r.PhysicalDeltaX
assert abs(x + w / 2) <= r.PhysicalDeltaX, (x, w)
)");
  const Outcome o = runShell("/usr/bin/python3" + quoted("read.py") + quoted("loop/cine.dcm"));
  EXPECT_EQ(o.code, 0) << o.err;
}

// GDCM, an independent reader: size, scale, and the pixels that it decodes.
TEST_F(DicomLoopFile, GdcmReadsTheLoop) {
  if (runShell("command -v gdcmconv").code != 0) GTEST_SKIP() << "no gdcm";
  const Scene scene = render(dicomScene(), "loop");
  const Outcome told = runShell("gdcminfo" + quoted("loop/cine.dcm"));
  EXPECT_NE(told.out.find("Dimensions: (160,120,48)"), std::string::npos) << told.out;
  const std::size_t spacing = told.out.find("Spacing: (");
  ASSERT_NE(spacing, std::string::npos) << told.out;
  // GDCM takes the spacing from the ultrasound region, whose unit is centimetres.
  EXPECT_NEAR(std::stod(told.out.substr(spacing + 10)),
              1e2 * pictureGeometry(scene).metres_per_pixel, 1e-5);
  ASSERT_EQ(runShell("gdcmconv --raw" + quoted("loop/cine.dcm") + quoted("raw.dcm")).code, 0);
  EXPECT_LE(worstDifference(readVideo(folder / "raw.dcm"), readVideo(folder / "loop/cine.dcm")), 2);
}

}  // namespace
}  // namespace echocine
