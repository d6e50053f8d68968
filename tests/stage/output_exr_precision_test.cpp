// What lossy pixels keep: error bounds as laws, against the values that were written.

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "output/exr_plane.h"
#include "output/half_plane.h"
#include "output_exr_fixture.h"
#include "support/exr_planes.h"

namespace echocine {
namespace {

using namespace test;

// A channel widened to float, line-major, and the scale its header states (1 without).
struct ReadBack {
  std::vector<float> values;
  double scale = 1;
  Imf::PixelType type = Imf::FLOAT;
};

ReadBack readBack(const std::filesystem::path& file, const Probe& probe, const char* channel) {
  Imf::InputFile in(file.c_str());
  const auto lines = static_cast<std::size_t>(probe.lines);
  const auto samples = static_cast<std::size_t>(probe.samples);
  ReadBack back;
  back.values.resize(lines * samples);
  Imf::FrameBuffer buffer;
  buffer.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(back.values.data()),
                                    sizeof(float) * samples, sizeof(float)));
  in.setFrameBuffer(buffer);
  in.readPixels(0, probe.samples - 1);
  back.type = in.header().channels().findChannel(channel)->type;
  const auto* scale = in.header().findTypedAttribute<Imf::DoubleAttribute>(
      std::string("echocine:scale.") + channel);
  if (scale) back.scale = scale->value();
  return back;
}

// Values over the range of what a frame holds, 200 dB of intensity, unlike in every place.
void fillDecades(std::vector<float>& values, double largest) {
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<float>(
        largest *
        std::pow(10.0, -20.0 * static_cast<double>(i) / static_cast<double>(values.size())) *
        (1 + 1e-3 * static_cast<double>(i % 7)) / 1.01);
  values[5] = 0;
}

void expectHalfLaw(const std::vector<float>& written, const ReadBack& back) {
  EXPECT_EQ(back.type, Imf::HALF);
  int exponent = 0;
  EXPECT_EQ(std::frexp(back.scale, &exponent), 0.5);  // a power of two
  const double largest = *std::max_element(written.begin(), written.end());
  EXPECT_GE(largest * back.scale, 0x1p14);
  EXPECT_LT(largest * back.scale, 0x1p15);
  for (std::size_t i = 0; i < written.size(); ++i) {
    const double value = written[i], error = std::abs(back.values[i] / back.scale - value);
    ASSERT_LE(error, value >= largest * 0x1p-28 ? value * 0x1p-11 : largest * 0x1p-39) << i;
    if (value == 0) {
      ASSERT_EQ(back.values[i], 0) << i;
    }
  }
}

TEST_F(ExrStackTest, HalfFloatsKeepElevenDigitsOver84Decibels) {
  scene.output.exr_pixel = ExrPixel::half;
  for (const double largest : {1e30, 1.0, 3e-7, 1e-30, 1e-40}) {
    fillDecades(values, largest);
    stack().write(record, planes());
    for (const char* channel : {"Y", "attenuation.A"})
      expectHalfLaw(values, readBack(file(), scene.probe, channel));
  }
}

TEST_F(ExrStackTest, AllZeroStaysAllZeroInHalfFloats) {
  scene.output.exr_pixel = ExrPixel::half;
  std::fill(values.begin(), values.end(), 0.0f);
  stack().write(record, planes());
  const ReadBack back = readBack(file(), scene.probe, "Y");
  EXPECT_EQ(back.scale, 1);
  EXPECT_EQ(back.values, values);
}

TEST_F(ExrStackTest, HalfFloatsAreTheSameUnderEveryLosslessCompression) {
  scene.output.exr_pixel = ExrPixel::half;
  fillDecades(values, 1e-6);
  stack().write(record, planes());
  const ReadBack plain = readBack(file(), scene.probe, "Y");
  for (const ExrCompression compression :
       {ExrCompression::rle, ExrCompression::zips, ExrCompression::zip, ExrCompression::piz,
        ExrCompression::pxr24}) {  // pxr24 narrows 32-bit floats only
    scene.output.exr_compression = compression;
    stack().write(record, planes());
    EXPECT_EQ(readBack(file(), scene.probe, "Y").values, plain.values);
  }
}

TEST_F(ExrStackTest, Pxr24KeepsSixteenDigitsOfNormalFloats) {
  scene.output.exr_compression = ExrCompression::pxr24;
  for (const double largest : {3e38, 1.0, 3e-7, 1e-17}) {
    fillDecades(values, largest);
    stack().write(record, planes());
    const ReadBack back = readBack(file(), scene.probe, "Y");
    EXPECT_EQ(back.type, Imf::FLOAT);
    for (std::size_t i = 0; i < values.size(); ++i)
      ASSERT_LE(std::abs(double{back.values[i]} - double{values[i]}), values[i] * 0x1p-16) << i;
  }
}

TEST_F(ExrStackTest, ReadsBackWhatItsFilesHold) {
  fillDecades(values, 3e-7);
  for (const ExrPixel pixel : {ExrPixel::whole, ExrPixel::half})
    for (const ExrCompression compression :
         {ExrCompression::none, ExrCompression::rle, ExrCompression::zips, ExrCompression::zip,
          ExrCompression::piz, ExrCompression::pxr24}) {
      scene.output.exr_pixel = pixel;
      scene.output.exr_compression = compression;
      stack().write(record, planes());
      const ReadBack file_back = readBack(file(), scene.probe, "Y");
      const std::vector<float> back =
          echocine::readBack(stack().encode(record, planes()), Channel::y);
      ASSERT_EQ(back.size(), values.size());
      for (std::size_t i = 0; i < values.size(); ++i)
        ASSERT_EQ(back[i], static_cast<float>(file_back.values[i] / file_back.scale)) << i;
      if (pixel == ExrPixel::whole && compression != ExrCompression::pxr24) {
        ASSERT_EQ(back, values);
      }
    }
}

// A medium's number that is rounded is another medium.
TEST_F(ExrStackTest, MediaAreWholeUnderEveryLoss) {
  scene.output.exr_pixel = ExrPixel::half;
  scene.output.exr_compression = ExrCompression::pxr24;
  stack().write(record, planes());
  const support::ExrPlane plane = support::exrPlane(file(), "medium.id");
  for (int line = 0; line < plane.lines; ++line)
    for (int sample = 0; sample < plane.samples; ++sample)
      ASSERT_EQ(plane.bits[static_cast<std::size_t>(sample * plane.lines + line)],
                ids[static_cast<std::size_t>(line * plane.samples + sample)]);
}

TEST_F(ExrStackTest, ResumeFindsLossyFrames) {
  for (const ExrPixel pixel : {ExrPixel::whole, ExrPixel::half}) {
    scene.output.exr_pixel = pixel;
    scene.output.exr_compression = ExrCompression::pxr24;
    const std::string written = stack().write(record, planes());
    EXPECT_EQ(stack().existing(record), written);
  }
}

TEST(HalfScale, IsOfTheLargestValueAlone) {
  EXPECT_EQ(halfScale(std::vector<float>{0, 1e-9f, 1}), 0x1p14);
  EXPECT_EQ(halfScale(std::vector<float>{1.99f, 0}), 0x1p14);
  EXPECT_EQ(halfScale(std::vector<float>{2}), 0x1p13);
  EXPECT_EQ(halfScale(std::vector<float>{}), 1);
}

}  // namespace
}  // namespace echocine
