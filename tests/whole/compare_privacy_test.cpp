// What says whose loop it is, and where on a disk it lies, is in no output of a comparison.

#include <gtest/gtest.h>

#include "support/echo_video.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

class Privacy : public ::testing::Test {
 protected:
  // The loop as DICOM, in a folder of its own name, with or without a name in tags and picture.
  fs::path loop(const std::string& where, bool named) {
    std::vector<PixelPlane> frames = drawnLoop(drawing);
    if (named)
      for (PixelPlane& frame : frames) {
        cv::Mat picture(drawing.height, drawing.width, CV_8U, frame.data());
        cv::putText(picture, "DOE JANE", {2, 14}, cv::FONT_HERSHEY_SIMPLEX, 0.45, {255});
        cv::putText(picture, "1950", {270, 30}, cv::FONT_HERSHEY_SIMPLEX, 0.45, {255});
      }
    fs::create_directories(folder / where);
    writeDicom(folder / where / "real.dcm", frames, drawing.width, drawing.height, DicomKind::grey,
               [&](DcmDataset& data) {
                 if (!named) return;
                 data.putAndInsertString(DCM_PatientName, "QUILLFEATHER^JANE");
                 data.putAndInsertString(DCM_PatientID, "HOSPITAL-4711");
               });
    return folder / where / "real.dcm";
  }
  void compare(const fs::path& real, const std::string& out) {
    const std::string sector = "160,5,-40,40,12,225";
    const Outcome o = runShell("%B compare '" + synthetic.string() + "' '" + real.string() +
                               "' -o '" + (folder / out).string() + "' --quiet --sector=" + sector +
                               " --synthetic-sector=" + sector);
    ASSERT_EQ(o.code, 0) << o.err;
  }

  Drawing drawing = [] {
    Drawing d;
    d.frames = 12;
    return d;
  }();
  TempFolder folder;
  const fs::path synthetic = writeLossless(folder / "synthetic.avi", drawing);
};

TEST_F(Privacy, PicturesAndNumbersDoNotDependOnWhatIsBurntInAroundTheSector) {
  compare(loop("clean", false), "out_clean");
  compare(loop("named", true), "out_named");
  for (const char* name : {"sector_real.png", "sector_synthetic.png", "side_by_side.avi",
                           "compare.html", "frames.csv", "summary.json"})
    EXPECT_TRUE(bytesOf(folder / "out_named" / name) == bytesOf(folder / "out_clean" / name))
        << name;
}

// The words are too long to stand in a picture's base64 by chance.
TEST_F(Privacy, NoTagAndNoFolderIsInAnyOutput) {
  compare(loop("named", true), "out");
  for (const auto& entry : fs::directory_iterator(folder / "out")) {
    const std::string bytes = bytesOf(entry.path());
    for (const std::string& word :
         {std::string("QUILLFEATHER"), std::string("HOSPITAL-4711"), folder.path().string()})
      EXPECT_EQ(bytes.find(word), std::string::npos) << word << " in " << entry.path();
  }
}

class SearchPrivacy : public Privacy {};

// A file's name may be a patient's: no output has it, whichever of the three kinds of comparison
// wrote it; the label that was given stands there instead.
TEST_F(SearchPrivacy, NoFileNameIsInAnyOutput) {
  fs::create_directories(folder / "QUILLFEATHER_JANE");
  const fs::path real = folder / "QUILLFEATHER_JANE" / "QUILLFEATHER_1950.dcm",
                 drawn = folder / "QUILLFEATHER_JANE" / "QUILLFEATHER.avi";
  fs::copy_file(loop("plain", false), real);
  fs::copy_file(synthetic, drawn);
  const std::string given = " --sector=160,5,-40,40,12,225 --label 'case 12' -o '",
                    both = "' --synthetic-sector=160,5,-40,40,12,225";
  for (const auto& [name, line] : std::initializer_list<std::pair<const char*, std::string>>{
           {"compared", "'" + drawn.string() + "' '" + real.string() + "'"},
           {"scanned", "'" + real.string() + "' --scan ef=0.5:0.6:0.1 --real-ed 0"},
           {"ranked",
            "'" + real.string() + "' --views a4c,plax --dials ef=0.55,edv=120 --real-ed 0"}}) {
    const fs::path out = folder / name;
    const Outcome o = runShell("%B compare " + line + given + out.string() +
                               (std::string(name) == "compared" ? both : "'"));
    ASSERT_EQ(o.code, 0) << o.err;
    bool labelled = false;
    for (const auto& entry : fs::directory_iterator(out)) {
      const std::string bytes = bytesOf(entry.path());
      EXPECT_EQ(bytes.find("QUILLFEATHER"), std::string::npos) << entry.path();
      labelled = labelled || bytes.find("case 12") != std::string::npos;
    }
    EXPECT_TRUE(labelled) << name;
    if (std::string(name) == "compared") continue;
    // A drawing without scale: said beside the result, in the terminal and in the files.
    EXPECT_NE(o.out.find("scale unknown"), std::string::npos) << o.out;
    const std::string json =
        bytesOf(out / (std::string(name) == "scanned" ? "scan.json" : "views.json"));
    EXPECT_NE(json.find("scale unknown"), std::string::npos);
  }
}

}  // namespace
}  // namespace echocine
