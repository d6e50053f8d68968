// The layout dicom of a dataset: each loop as a file for viewers.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "echo/read_loop.h"
#include "support/run_files.h"
#include "support/run_program.h"
#include "support/video_difference.h"

namespace echocine {
namespace {

using namespace support;

class DatasetDicom : public testing::Test {
 protected:
  void make() const {
    const auto spec = folder.write(
        "exam.toml",
        "hearts = 1\nviews = [\"a4c\", \"plax\"]\nlayouts = [\"dicom\", \"native\"]\n" +
            bytesOf(std::filesystem::path(kSourceDir) / "tests/support/small_loops.toml"));
    const Outcome made = runShell("%B dataset '" + spec.string() + "' -o '" +
                                  (folder / "data").string() + "' --quiet");
    ASSERT_EQ(made.code, 0) << made.err;
  }
  std::filesystem::path fileOf(const std::string& id) const {
    for (const char* split : {"train", "val", "test"}) {
      const auto file = folder / "data/dicom" / split / (id + ".dcm");
      if (std::filesystem::exists(file)) return file;
    }
    return {};
  }
  TempFolder folder;
};

// Pictures, scale, rate and R waves are those of the native layout.
TEST_F(DatasetDicom, LoopsAreThoseOfTheNativeLayout) {
  make();
  for (const std::string id : {"ec000001_a4c", "ec000001_plax"}) {
    const echo::EchoLoop dicom = echo::readLoop(fileOf(id), {}, true),
                         cine = echo::readLoop(folder / "data/native" / id / "cine.avi", {}, true);
    ASSERT_EQ(dicom.video.frameCount(), cine.video.frameCount());
    EXPECT_NEAR(dicom.video.rate.hz, cine.video.rate.hz, 1e-3);
    EXPECT_LE(worstDifference(cine.video, dicom.video), 2);
    const auto record = nlohmann::json::parse(bytesOf(folder / "data/native" / id / "loop.json"));
    ASSERT_TRUE(dicom.metres_per_pixel);
    EXPECT_NEAR(1e3 * *dicom.metres_per_pixel, record.at("mm_per_pixel").get<double>(), 1e-6);
    ASSERT_FALSE(dicom.video.r_waves_s.empty());
    EXPECT_NEAR(dicom.video.r_waves_s.front(), 0, 1e-6);
  }
}

TEST_F(DatasetDicom, LoopsOfAHeartAreOneExaminationAndPassTheValidator) {
  if (runShell("/usr/bin/python3 -c 'import pydicom'").code != 0) GTEST_SKIP() << "no pydicom";
  make();
  folder.write("read.py", R"(
import sys, pydicom
a, b = (pydicom.dcmread(f) for f in sys.argv[1:])
assert a.PatientID == b.PatientID and a.StudyInstanceUID == b.StudyInstanceUID
assert a.SeriesInstanceUID != b.SeriesInstanceUID and a.SOPInstanceUID != b.SOPInstanceUID
assert a.ViewCodeSequence[0].CodeValue == '399214001'
assert b.ViewCodeSequence[0].CodeValue == '399139001'
)");
  const std::string files =
      " '" + fileOf("ec000001_a4c").string() + "' '" + fileOf("ec000001_plax").string() + "'";
  const Outcome read = runShell("/usr/bin/python3 '" + (folder / "read.py").string() + "'" + files);
  EXPECT_EQ(read.code, 0) << read.err;
  if (runShell("command -v dciodvfy").code != 0) return;
  for (const char* id : {"ec000001_a4c", "ec000001_plax"}) {
    const Outcome checked = runShell("dciodvfy '" + fileOf(id).string() + "' 2>&1");
    EXPECT_EQ(checked.out.find("Error"), std::string::npos) << checked.out;
  }
}

}  // namespace
}  // namespace echocine
