// The cine loop read back with libavformat and libavcodec: frames, rate, size, pixels.

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "core/part_file.h"
#include "output_fixture.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace echocine {
namespace {

using test::messageOf;
using test::picture;
using test::TempFolder;

struct Loop {
  AVCodecID codec = AV_CODEC_ID_NONE;
  AVRational rate{};
  double duration_s = 0;
  AVColorRange range = AVCOL_RANGE_UNSPECIFIED;
  std::size_t coloured = 0;  // colour samples that are not neutral
  std::vector<GreyImage> frames;
};

GreyImage asImage(const AVFrame& frame) {
  GreyImage image{frame.width, frame.height, {}};
  for (int y = 0; y < frame.height; ++y) {
    const std::uint8_t* row = frame.data[0] + std::ptrdiff_t{y} * frame.linesize[0];
    image.pixels.insert(image.pixels.end(), row, row + frame.width);
  }
  return image;
}

std::size_t countColoured(const AVFrame& frame) {
  std::size_t count = 0;
  for (const int plane : {1, 2})
    for (int y = 0; y < (frame.height + 1) / 2; ++y) {
      const std::uint8_t* row = frame.data[plane] + std::ptrdiff_t{y} * frame.linesize[plane];
      count += static_cast<std::size_t>(
          std::count_if(row, row + (frame.width + 1) / 2, [](int c) { return c != 128; }));
    }
  return count;
}

Loop readLoop(const std::filesystem::path& path) {
  Loop loop;
  AVFormatContext* format = nullptr;
  EXPECT_EQ(avformat_open_input(&format, path.c_str(), nullptr, nullptr), 0);
  if (format == nullptr) return loop;
  EXPECT_GE(avformat_find_stream_info(format, nullptr), 0);
  const AVStream& stream = *format->streams[0];
  loop.codec = stream.codecpar->codec_id;
  loop.rate = stream.avg_frame_rate;
  loop.duration_s = static_cast<double>(stream.duration) * av_q2d(stream.time_base);
  AVCodecContext* codec = avcodec_alloc_context3(avcodec_find_decoder(loop.codec));
  avcodec_parameters_to_context(codec, stream.codecpar);
  codec->err_recognition = AV_EF_CRCCHECK | AV_EF_EXPLODE;
  EXPECT_EQ(avcodec_open2(codec, nullptr, nullptr), 0);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  const auto drain = [&] {
    while (avcodec_receive_frame(codec, frame) == 0) {
      const bool lossless = loop.codec == AV_CODEC_ID_FFV1;
      EXPECT_EQ(frame->format, lossless ? AV_PIX_FMT_GRAY8 : AV_PIX_FMT_YUVJ420P);
      loop.range = frame->color_range;
      if (!lossless) loop.coloured += countColoured(*frame);
      loop.frames.push_back(asImage(*frame));
    }
  };
  while (av_read_frame(format, packet) == 0) {
    EXPECT_NE(packet->flags & AV_PKT_FLAG_KEY, 0);
    EXPECT_EQ(avcodec_send_packet(codec, packet), 0);
    av_packet_unref(packet);
    drain();
  }
  avcodec_send_packet(codec, nullptr);
  drain();
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&codec);
  avformat_close_input(&format);
  return loop;
}

int greatestDifference(const GreyImage& a, const GreyImage& b) {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  int greatest = 0;
  for (std::size_t i = 0; i < std::min(a.pixels.size(), b.pixels.size()); ++i)
    greatest = std::max(greatest, std::abs(int{a.pixels[i]} - int{b.pixels[i]}));
  return greatest;
}

OutputSettings settingsOf(CineCodec codec, int width = 320, int height = 240) {
  OutputSettings settings;
  settings.codec = codec;
  settings.width = width;
  settings.height = height;
  return settings;
}

void writeLoop(const std::filesystem::path& path, const OutputSettings& settings, double rate_hz,
               int frames) {
  CineWriter writer(path, settings, rate_hz);
  for (int i = 0; i < frames; ++i)
    writer.add(encodeCineFrame(picture(settings.width, settings.height, i), settings.codec,
                               settings.jpeg_quality));
  writer.finish();
}

TEST(Cine, LosslessLoopReadsBackToThePixelWhateverItsSize) {
  const TempFolder folder;
  for (const auto& [width, height] : {std::pair(320, 240), {321, 241}, {17, 16}, {1024, 768}}) {
    writeLoop(folder / "cine.avi", settingsOf(CineCodec::ffv1, width, height), 50, 5);
    const Loop loop = readLoop(folder / "cine.avi");
    EXPECT_EQ(loop.codec, AV_CODEC_ID_FFV1);
    ASSERT_EQ(loop.frames.size(), 5u);
    for (int i = 0; i < 5; ++i)
      EXPECT_EQ(loop.frames[static_cast<std::size_t>(i)].pixels, picture(width, height, i).pixels);
  }
}

TEST(Cine, JpegLoopReadsBackWithinASmallError) {
  const TempFolder folder;
  for (const auto& [width, height] : {std::pair(320, 240), {321, 241}, {17, 16}}) {
    writeLoop(folder / "cine.avi", settingsOf(CineCodec::mjpg, width, height), 50, 5);
    const Loop loop = readLoop(folder / "cine.avi");
    EXPECT_EQ(loop.codec, AV_CODEC_ID_MJPEG);
    ASSERT_EQ(loop.frames.size(), 5u);
    for (int i = 0; i < 5; ++i) {
      const GreyImage& frame = loop.frames[static_cast<std::size_t>(i)];
      EXPECT_EQ(frame.width, width);
      EXPECT_EQ(frame.height, height);
      EXPECT_LE(greatestDifference(frame, picture(width, height, i)), 25);
    }
  }
}

// What ffprobe shows as color_range=pc; without it players may stretch 16..235 to black and white.
TEST(Cine, JpegLoopSaysThatItsGreysRunFromZeroTo255) {
  const TempFolder folder;
  for (const auto& [width, height] : {std::pair{320, 240}, {33, 17}}) {
    writeLoop(folder / "cine.avi", settingsOf(CineCodec::mjpg, width, height), 50, 3);
    const Loop loop = readLoop(folder / "cine.avi");
    EXPECT_EQ(loop.range, AVCOL_RANGE_JPEG);
    EXPECT_EQ(loop.coloured, 0u);
  }
}

TEST(Cine, FileCarriesTheFrameRateAndLength) {
  const TempFolder folder;
  for (const CineCodec codec : {CineCodec::mjpg, CineCodec::ffv1})
    for (const double rate_hz : {50.0, 29.97, 12.5, 0.5, 300.0, 1.0 / 3.0}) {
      writeLoop(folder / "cine.avi", settingsOf(codec, 64, 48), rate_hz, 6);
      const Loop loop = readLoop(folder / "cine.avi");
      const Rational wanted = rationalFrameRate(rate_hz);
      EXPECT_EQ(loop.rate.num, wanted.numerator) << rate_hz;
      EXPECT_EQ(loop.rate.den, wanted.denominator) << rate_hz;
      EXPECT_NEAR(loop.duration_s, 6 / rate_hz, 1e-5 / rate_hz);
    }
}

TEST(Cine, SameLoopGivesSameBytesAndNamesNoLibrary) {
  const TempFolder folder;
  for (const CineCodec codec : {CineCodec::mjpg, CineCodec::ffv1}) {
    writeLoop(folder / "first.avi", settingsOf(codec), 50, 4);
    writeLoop(folder / "second.avi", settingsOf(codec), 50, 4);
    const std::string bytes = test::bytesOf(folder / "first.avi");
    EXPECT_EQ(bytes, test::bytesOf(folder / "second.avi"));
    EXPECT_EQ(bytes.find("Lavf"), std::string::npos);
    EXPECT_EQ(bytes.find("Lavc"), std::string::npos);
  }
}

TEST(Cine, FrameIsEncodedTheSameWhateverCameBefore) {
  const GreyImage image = picture(200, 100, 3);
  const auto alone = encodeCineFrame(image, CineCodec::ffv1, 95);
  encodeCineFrame(picture(200, 100, 0), CineCodec::ffv1, 95);
  EXPECT_EQ(encodeCineFrame(image, CineCodec::ffv1, 95), alone);
  encodeCineFrame(picture(64, 64, 0), CineCodec::ffv1, 95);
  EXPECT_EQ(encodeCineFrame(image, CineCodec::ffv1, 95), alone);
}

TEST(Cine, ThreadsEncodeTheBytesOfOne) {
  for (const CineCodec codec : {CineCodec::mjpg, CineCodec::ffv1}) {
    std::vector<std::vector<std::byte>> alone, together(8);
    for (int i = 0; i < 8; ++i) alone.push_back(encodeCineFrame(picture(320, 240, i), codec, 95));
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i)
      threads.emplace_back([&, i] {
        together[static_cast<std::size_t>(i)] = encodeCineFrame(picture(320, 240, i), codec, 95);
      });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(together, alone);
  }
}

TEST(Cine, WriterDestroyedUnfinishedLeavesNothing) {
  const TempFolder folder;
  {
    CineWriter writer(folder / "cine.avi", settingsOf(CineCodec::mjpg), 50);
    writer.add(encodeCineFrame(picture(320, 240, 0), CineCodec::mjpg, 95));
    ASSERT_EQ(test::filesIn(folder.path()), 1u);
    const auto part = *std::filesystem::directory_iterator(folder.path());
    EXPECT_EQ(targetOfPart(part.path().filename().string()), "cine.avi");
  }
  EXPECT_EQ(test::filesIn(folder.path()), 0u);
}

TEST(Cine, LoopWithoutFramesLeavesNothing) {
  const TempFolder folder;
  CineWriter writer(folder / "cine.avi", settingsOf(CineCodec::ffv1), 50);
  writer.finish();
  EXPECT_EQ(test::filesIn(folder.path()), 0u);
}

TEST(Cine, EarlierLoopStandsUntilTheNewOneIsWhole) {
  const TempFolder folder;
  test::putBytes(folder / "cine.avi", "earlier");
  CineWriter writer(folder / "cine.avi", settingsOf(CineCodec::mjpg), 50);
  writer.add(encodeCineFrame(picture(320, 240, 0), CineCodec::mjpg, 95));
  EXPECT_EQ(test::bytesOf(folder / "cine.avi"), "earlier");
  writer.finish();
  EXPECT_EQ(readLoop(folder / "cine.avi").frames.size(), 1u);
  EXPECT_EQ(test::filesIn(folder.path()), 1u);
}

TEST(Cine, FullDiskIsReportedWithFileAndReasonAndLeavesNothing) {
  const TempFolder folder;
  // At the start, in the middle, and with the index at the very end.
  for (const rlim_t bytes : {rlim_t{100}, rlim_t{20000}, rlim_t{400000}}) {
    const std::string message = messageOf<JobError>([&] {
      const test::FullDisk full(bytes);
      writeLoop(folder / "cine.avi", settingsOf(CineCodec::mjpg), 50, 200);
    });
    EXPECT_NE(message.find("cine.avi: cannot be written: File too large"), std::string::npos)
        << message;
    EXPECT_EQ(test::filesIn(folder.path()), 0u);
  }
}

TEST(Cine, EveryShortageOfSpaceIsNoticed) {
  const TempFolder folder;
  writeLoop(folder / "cine.avi", settingsOf(CineCodec::ffv1, 64, 48), 50, 40);
  const auto whole = std::filesystem::file_size(folder / "cine.avi");
  std::filesystem::remove(folder / "cine.avi");
  for (rlim_t bytes = whole - 1; bytes > whole / 2; bytes -= whole / 20) {
    const test::FullDisk full(bytes);
    EXPECT_THROW(writeLoop(folder / "cine.avi", settingsOf(CineCodec::ffv1, 64, 48), 50, 40),
                 JobError)
        << bytes << " of " << whole;
    EXPECT_EQ(test::filesIn(folder.path()), 0u);
  }
}

TEST(Cine, PathThatCannotBeWrittenIsReported) {
  const TempFolder folder;
  test::putBytes(folder / "file", "");
  const std::string message = messageOf<JobError>(
      [&] { writeLoop(folder / "file/cine.avi", settingsOf(CineCodec::mjpg), 50, 1); });
  EXPECT_NE(message.find("cine.avi: cannot be written: Not a directory"), std::string::npos)
      << message;
}

TEST(Png, CarriesThePictureWithoutLoss) {
  const GreyImage image = picture(33, 21, 2);
  const std::vector<std::byte> png = encodePng(image);
  AVCodecContext* codec = avcodec_alloc_context3(avcodec_find_decoder(AV_CODEC_ID_PNG));
  ASSERT_EQ(avcodec_open2(codec, nullptr, nullptr), 0);
  AVPacket* packet = av_packet_alloc();
  ASSERT_EQ(av_new_packet(packet, static_cast<int>(png.size())), 0);
  std::memcpy(packet->data, png.data(), png.size());
  AVFrame* frame = av_frame_alloc();
  ASSERT_EQ(avcodec_send_packet(codec, packet), 0);
  ASSERT_EQ(avcodec_receive_frame(codec, frame), 0);
  EXPECT_EQ(asImage(*frame).pixels, image.pixels);
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&codec);
}

}  // namespace
}  // namespace echocine
