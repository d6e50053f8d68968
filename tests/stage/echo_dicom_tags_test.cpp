// Times, rates and shapes of pixels that DICOM files state.

#include <gtest/gtest.h>

#include <algorithm>

#include "support/loop_reading.h"
#include "video/read_video.h"

namespace echocine::echo {
namespace {

using namespace support;

TEST_F(Reading, HeartRatesOfTagsAreTakenWhereAHeartCanBeatSo) {
  const auto read = [&](const DcmTagKey& key, const char* value) {
    writeDicom(folder / "loop.dcm", frames, 320, 240, DicomKind::grey,
               [&](DcmDataset& data) { data.putAndInsertString(key, value); });
    return readVideo(folder / "loop.dcm");
  };
  const Video rate = read(DCM_HeartRate, "66"), interval = read(DCM_NominalInterval, "800"),
              none = read(DCM_HeartRate, "0");
  EXPECT_EQ(rate.heart_rate_bpm, 66);
  EXPECT_EQ(rate.heart_rate_source, "DICOM HeartRate");
  EXPECT_EQ(interval.heart_rate_bpm, 75);
  EXPECT_EQ(interval.heart_rate_source, "DICOM NominalInterval");
  EXPECT_FALSE(none.heart_rate_bpm);
  ASSERT_EQ(none.notes.size(), 1u);
  EXPECT_NE(none.notes[0].find("HeartRate"), std::string::npos);
}

TEST_F(Reading, UnevenFrameTimesAreNoted) {
  const auto notes_of = [&](const char* times) {
    writeDicom(folder / "loop.dcm", frames, 320, 240, DicomKind::grey,
               [&](DcmDataset& data) { data.putAndInsertString(DCM_FrameTimeVector, times); });
    return readVideo(folder / "loop.dcm").notes.size();
  };
  EXPECT_EQ(notes_of("0\\20\\21\\19\\20"), 0u);
  EXPECT_EQ(notes_of("0\\20\\20\\90\\20"), 1u);
}

// An R wave belongs to a frame: of an uneven loop, by the frames' own times.
TEST_F(Reading, RWavesStandAtTheirFramesOfAnUnevenLoop) {
  writeDicom(folder / "loop.dcm", frames, 320, 240, DicomKind::grey, [&](DcmDataset& data) {
    data.putAndInsertString(DCM_FrameTimeVector, "0\\20\\20\\80\\20\\20");
    data.putAndInsertString(DCM_RWaveTimeVector, "10\\80\\130");
  });
  SideOptions faster;
  faster.fps = 80;
  for (const SideOptions& side : {SideOptions{}, faster}) {
    const EchoLoop loop = readLoop(folder / "loop.dcm", side, true);
    EXPECT_EQ(loop.beat_anchor, "DICOM R waves");
    const std::vector<double> waves = loop.rWaveFrames();
    ASSERT_EQ(waves.size(), 3u);
    for (const auto& [i, frame] : {std::pair{0u, 0.5}, {1u, 2.5}, {2u, 3.5}})
      EXPECT_NEAR(waves[i], frame, 1e-9) << i;
  }
}

// Times are frames only with a frame rate: what cannot be used says so.
TEST_F(Reading, RWavesAndHeartRatesWithoutAFrameRateAreNoted) {
  writePictures(folder / "png", coloured(frames, 320, 240), ".png");
  SideOptions side;
  side.r_waves_s = {0.1, 0.9};
  side.heart_rate_bpm = 70;
  const auto notesWith = [](const EchoLoop& loop, const char* words) {
    return std::count_if(
        loop.video.notes.begin(), loop.video.notes.end(),
        [&](const std::string& note) { return note.find(words) != std::string::npos; });
  };
  const EchoLoop unknown = readLoop(folder / "png", side, true);
  EXPECT_EQ(notesWith(unknown, "R waves are not used"), 1);
  EXPECT_EQ(notesWith(unknown, "the heart rate (--heart-rate) is not used"), 1);
  EXPECT_EQ(unknown.beat_anchor, "the picture itself");
  side.fps = 25;
  const EchoLoop known = readLoop(folder / "png", side, true);
  EXPECT_EQ(notesWith(known, "not used"), 0);
  EXPECT_EQ(known.beat_anchor, "given");
}

// Pixels that the file states as oblong are made square; a user's word goes first.
TEST_F(Reading, OblongPixelsOfRegionsAreMadeSquare) {
  std::vector<PixelPlane> flat;
  for (const PixelPlane& frame : frames) {
    cv::Mat small;
    cv::resize(cv::Mat(240, 320, CV_8U, const_cast<std::uint8_t*>(frame.data())), small, {320, 192},
               0, 0, cv::INTER_AREA);
    flat.emplace_back(small.datastart, small.dataend);
  }
  writeDicom(folder / "flat.dcm", flat, 320, 192, DicomKind::grey, [](DcmDataset& data) {
    DcmItem* item = nullptr;
    data.findOrCreateSequenceItem(DCM_SequenceOfUltrasoundRegions, item);
    item->putAndInsertUint32(DCM_RegionLocationMinX0, 0);
    item->putAndInsertUint32(DCM_RegionLocationMinY0, 0);
    item->putAndInsertUint32(DCM_RegionLocationMaxX1, 319);
    item->putAndInsertUint32(DCM_RegionLocationMaxY1, 191);
    item->putAndInsertUint16(DCM_PhysicalUnitsXDirection, 3);
    item->putAndInsertUint16(DCM_PhysicalUnitsYDirection, 3);
    item->putAndInsertFloat64(DCM_PhysicalDeltaX, 0.06);
    item->putAndInsertFloat64(DCM_PhysicalDeltaY, 0.075);
  });
  const EchoLoop loop = readLoop(folder / "flat.dcm", {}, true);
  EXPECT_EQ(loop.video.height, 240);
  EXPECT_NEAR(loop.sector().r_max, drawing.sector.r_max, 3);
  EXPECT_NEAR(loop.metres_per_pixel.value_or(0), 6e-4, 1e-9);
  SideOptions side;
  side.pixel_aspect = 1;
  EXPECT_EQ(readLoop(folder / "flat.dcm", side, true).video.height, 192);
}

}  // namespace
}  // namespace echocine::echo
