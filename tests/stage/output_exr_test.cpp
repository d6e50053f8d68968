// The EXR stack read back through OpenEXR equals memory; impossible values are refused.

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/hash.h"
#include "core/usable.h"
#include "output/polar_plane.h"
#include "output_exr_fixture.h"

namespace echocine {
namespace {

using test::ExrStackTest;
using test::messageOf;

template <typename T>
std::vector<T> readChannel(const std::filesystem::path& path, const char* name,
                           Imf::PixelType type) {
  Imf::InputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  const std::size_t width = static_cast<std::size_t>(window.max.x) + 1;
  std::vector<T> pixels(width * (static_cast<std::size_t>(window.max.y) + 1));
  Imf::FrameBuffer buffer;
  buffer.insert(
      name, Imf::Slice(type, reinterpret_cast<char*>(pixels.data()), sizeof(T), width * sizeof(T)));
  file.setFrameBuffer(buffer);
  file.readPixels(0, window.max.y);
  return pixels;
}

TEST_F(ExrStackTest, EveryChannelReadBackEqualsMemoryUnderEveryCompression) {
  for (const ExrCompression compression :
       {ExrCompression::none, ExrCompression::rle, ExrCompression::zips, ExrCompression::zip,
        ExrCompression::piz}) {
    scene.output.exr_compression = compression;
    stack().write(record, planes());
    const int lines = scene.probe.lines, samples = scene.probe.samples;
    for (const Channel channel : test::kEveryChannel) {
      const auto image = readChannel<std::uint32_t>(
          file(), channelName(channel), channel == Channel::medium ? Imf::UINT : Imf::FLOAT);
      for (int line = 0; line < lines; ++line)
        for (int sample = 0; sample < samples; ++sample) {
          const auto in_memory = static_cast<std::size_t>(line * samples + sample);
          const auto in_file = static_cast<std::size_t>(sample * lines + line);
          const std::uint32_t wanted = channel == Channel::medium
                                           ? ids[in_memory]
                                           : std::bit_cast<std::uint32_t>(values[in_memory]);
          ASSERT_EQ(image[in_file], wanted)
              << channelName(channel) << " line " << line << " sample " << sample;
        }
    }
  }
}

TEST_F(ExrStackTest, ChannelsHaveTheNamesAndTypesOfTheContract) {
  stack().write(record, planes());
  Imf::InputFile exr(file().c_str());
  std::map<std::string, Imf::PixelType> found;
  for (auto it = exr.header().channels().begin(); it != exr.header().channels().end(); ++it)
    found[it.name()] = it.channel().type;
  const std::map<std::string, Imf::PixelType> wanted{{"Y", Imf::FLOAT},
                                                     {"unattenuated.Y", Imf::FLOAT},
                                                     {"attenuation.A", Imf::FLOAT},
                                                     {"reflection.Y", Imf::FLOAT},
                                                     {"backscatter.Y", Imf::FLOAT},
                                                     {"medium.id", Imf::UINT},
                                                     {"display.Y", Imf::FLOAT}};
  EXPECT_EQ(found, wanted);
}

// Names of attributes are a contract: other people's scripts read them.
TEST_F(ExrStackTest, HeaderTellsTimeProbeAndScene) {
  stack().write(record, planes());
  Imf::InputFile exr(file().c_str());
  const Imf::Header& header = exr.header();
  EXPECT_EQ(Imf::framesPerSecond(header).n, 30000);
  EXPECT_EQ(Imf::framesPerSecond(header).d, 1001u);
  EXPECT_EQ(header.typedAttribute<Imf::DoubleAttribute>("echocine:time_s").value(), 0.14);
  EXPECT_EQ(header.typedAttribute<Imf::DoubleAttribute>("echocine:phase").value(), 0.1516);
  EXPECT_EQ(header.typedAttribute<Imf::IntAttribute>("echocine:frame").value(), 7);
  EXPECT_EQ(header.typedAttribute<Imf::DoubleAttribute>("echocine:frequency_hz").value(), 2.5e6);
  EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("echocine:scene_sha256").value(), hash);
  EXPECT_EQ(header.typedAttribute<Imf::DoubleAttribute>("echocine:reference_intensity").value(),
            0.125);
  EXPECT_FALSE(header.typedAttribute<Imf::StringAttribute>("echocine:version").value().empty());
  EXPECT_EQ(header.pixelAspectRatio(), 1.0f);

  const auto probe =
      nlohmann::json::parse(header.typedAttribute<Imf::StringAttribute>("echocine:probe").value());
  EXPECT_EQ(probe["kind"], "phased");
  EXPECT_EQ(probe["apex_m"], (std::vector<double>{0.01, -0.02, 0.03}));
  EXPECT_EQ(probe["lateral"], (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(probe["elevation"], (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(probe["depth"], (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(probe["first_angle_rad"], scene.probe.first_angle_rad);
  EXPECT_EQ(probe["last_angle_rad"], scene.probe.last_angle_rad);
  EXPECT_EQ(probe["min_depth_m"], 0.002);
  EXPECT_EQ(probe["max_depth_m"], 0.16);
  for (const char* key : {"face_radius_m", "first_offset_m", "last_offset_m"})
    EXPECT_EQ(probe[key], 0.0) << key;
}

TEST_F(ExrStackTest, SameFrameGivesSameBytesAndTheReturnedHashIsTheFiles) {
  const std::string first = stack().write(record, planes());
  const std::string bytes = test::bytesOf(file());
  EXPECT_EQ(first, sha256HexOfFile(file()));
  EXPECT_EQ(stack().write(record, planes()), first);
  EXPECT_EQ(test::bytesOf(file()), bytes);
  EXPECT_EQ(test::filesIn(folder.path()), 1u);
}

TEST_F(ExrStackTest, ThreadsWriteTheBytesOfOne) {
  const ExrStack shared = stack();
  std::vector<std::string> alone, together(8);
  for (int i = 0; i < 8; ++i) alone.push_back(shared.write({i, 0.02 * i, 0}, planes()));
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&, i] {
      together[static_cast<std::size_t>(i)] = shared.write({i, 0.02 * i, 0}, planes());
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(together, alone);
}

// Lines are turned into rows by blocks: sizes that are no multiples are where such code goes wrong.
TEST_F(ExrStackTest, SizesAroundTheTransposesBlocksKeepEveryValue) {
  for (const int lines : {1, 7, 8, 9, 16})
    for (const int samples : {1, 63, 64, 65}) {
      scene.probe.lines = lines;
      scene.probe.samples = std::max(samples, 4 / lines + 1);
      fill();
      stack().write(record, planes());
      const auto image = readChannel<float>(file(), "Y", Imf::FLOAT);
      for (int line = 0; line < lines; ++line)
        for (int sample = 0; sample < scene.probe.samples; ++sample)
          ASSERT_EQ(image[static_cast<std::size_t>(sample * lines + line)],
                    values[static_cast<std::size_t>(line * scene.probe.samples + sample)]);
    }
}

TEST_F(ExrStackTest, ImpossibleValueIsRefusedWithFrameLineAndSample) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity(), -1e-30f}) {
    fill();
    values[static_cast<std::size_t>(12 * scene.probe.samples + 69)] = bad;
    const std::string message = messageOf<JobError>([&] { stack().write(record, planes()); });
    EXPECT_NE(message.find("frame 7, line 12, sample 69: channel Y"), std::string::npos) << message;
    EXPECT_EQ(test::filesIn(folder.path()), 0u);
  }
}

TEST_F(ExrStackTest, FullDiskIsReportedWithFileAndReasonAndLeavesNothing) {
  const std::string message = messageOf<JobError>([&] {
    const test::FullDisk full(4096);
    stack().write(record, planes());
  });
  EXPECT_NE(message.find("frame_0007.exr: cannot be written: "), std::string::npos) << message;
  EXPECT_EQ(test::filesIn(folder.path()), 0u);
}

TEST_F(ExrStackTest, MissingFolderIsReported) {
  const ExrStack nowhere(folder / "absent", scene, hash, 0.125);
  EXPECT_THROW(nowhere.write(record, planes()), JobError);
}

TEST(ExrFileName, HasAtLeastFourDigits) {
  EXPECT_EQ(ExrStack::fileName(0), "frame_0000.exr");
  EXPECT_EQ(ExrStack::fileName(12345), "frame_12345.exr");
}

TEST(FirstUnusable, FindsTheFirstOfSeveralAtAnyPlace) {
  for (std::size_t size = 1; size < 70; ++size) {
    std::vector<float> values(size, std::numeric_limits<float>::max());
    EXPECT_FALSE(firstUnusable(values));
    values[size - 1] = -1.0f;
    values[size / 2] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(firstUnusable(values), size / 2);
  }
  EXPECT_FALSE(firstUnusable({}));
}

}  // namespace
}  // namespace echocine
