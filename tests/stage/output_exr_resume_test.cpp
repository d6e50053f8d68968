// Resuming takes the very frame it would write, renders again what is absent, damaged or different,
// and stops at another scene.

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <array>

#include "output_exr_fixture.h"
#include "support/all_cases.h"

namespace echocine {
namespace {

using test::ExrStackTest;
using test::messageOf;

TEST_F(ExrStackTest, ResumeFindsTheVeryFrame) {
  for (const ExrCompression compression : {ExrCompression::none, ExrCompression::piz}) {
    scene.output.exr_compression = compression;
    const std::string written = stack().write(record, planes());
    EXPECT_EQ(stack().existing(record), written);
  }
}

TEST_F(ExrStackTest, ResumeFindsNothingWhereNothingOrNonsenseStands) {
  EXPECT_EQ(stack().existing(record), "");
  for (const std::string& nonsense :
       {std::string(), std::string("no picture"), std::string("\x76\x2f\x31\x01\x02", 5)}) {
    test::putBytes(file(), nonsense);
    EXPECT_EQ(stack().existing(record), "");
  }
  std::filesystem::remove(file());
  std::filesystem::create_directory(file());
  EXPECT_EQ(stack().existing(record), "");
}

// At lengths all over the file, and one byte short: a run may be killed at any byte.
TEST_F(ExrStackTest, ResumeTakesNoFileThatIsCutShortAnywhere) {
  stack().write(record, planes());
  const std::string whole = test::bytesOf(file());
  for (std::size_t size = 0; size < whole.size(); size += size < 2000 ? 41 : 777) {
    test::putBytes(file(), whole.substr(0, size));
    EXPECT_EQ(stack().existing(record), "") << size << " of " << whole.size() << " bytes";
  }
  test::putBytes(file(), whole.substr(0, whole.size() - 1));
  EXPECT_EQ(stack().existing(record), "");
}

// Each byte of header and first rows changed in turn.
TEST_F(ExrStackTest, DamagedHeaderNeverCrashes) {
  stack().write(record, planes());
  const std::string whole = test::bytesOf(file());
  for (std::size_t at = 0; at < 1400; ++at) {
    std::string damaged = whole;
    const char flips[] = {'\x01', '\x80', '\xff'};
    damaged[at] = static_cast<char>(damaged[at] ^ flips[at % 3]);
    test::putBytes(file(), damaged);
    try {
      stack().existing(record);
    } catch (const SceneError&) {  // the damage may lie in the scene's hash
    }
  }
}

// One byte flipped anywhere: magic number, attributes, table of offsets, chunks, pixels, the digest
// itself. The frame is made again, and damage to the scene's hash is not taken for another scene.
TEST_F(ExrStackTest, ResumeTakesNoFileWithAnyByteFlippedWhateverTheCompression) {
  constexpr std::array kAll{ExrCompression::none, ExrCompression::rle, ExrCompression::zips,
                            ExrCompression::zip,  ExrCompression::piz, ExrCompression::pxr24};
#ifdef ECHOCINE_SANITIZED
  constexpr std::size_t kFew = 12;
#else
  constexpr std::size_t kFew = 4;
#endif
  const std::size_t step = support::allCases() ? 1 : kFew;
  std::size_t first = 0;
  scene.output.channels = {Channel::y, Channel::medium};
  for (const ExrCompression compression : kAll)
    for (const ExrPixel pixel : {ExrPixel::whole, ExrPixel::half}) {
      scene.output.exr_compression = compression;
      scene.output.exr_pixel = pixel;
      const std::string sha256 = stack().write(record, planes());
      ASSERT_EQ(stack().existing(record), sha256);
      const std::string whole = test::bytesOf(file());
      // Header and table of offsets, whose bytes the compressions share, then a sample of the
      // chunks.
      for (std::size_t at = first; at < whole.size(); at += at < 2400 ? step : 29) {
        std::string damaged = whole;
        const char flips[] = {'\x01', '\x20', '\x80', '\xff'};
        damaged[at] = static_cast<char>(damaged[at] ^ flips[at % 4]);
        test::putBytes(file(), damaged);
        ASSERT_EQ(stack().existing(record), "") << "byte " << at << " of " << whole.size();
        ASSERT_NO_THROW(stack().refuseOtherScene(record.frame)) << "byte " << at;
      }
      test::putBytes(file(), whole);
      first = (first + 1) % step;
    }
}

TEST_F(ExrStackTest, TheDigestIsOfTheBytesAlone) {
  const std::string first = stack().write(record, planes());
  EXPECT_EQ(stack().write(record, planes()), first);
  values[7] = std::nextafter(values[7], 2.0f);
  EXPECT_NE(stack().write(record, planes()), first);
}

TEST_F(ExrStackTest, GreysAreStoredUnscaledAsHalfFloatsToo) {
  for (float& v : values) v = std::min(v, 1.0f);
  scene.output.channels = {Channel::display};
  scene.output.exr_pixel = ExrPixel::half;
  stack().write(record, planes());
  Imf::InputFile in(file().c_str());
  EXPECT_EQ(in.header().find("echocine:scale.display.Y"), in.header().end());
  std::vector<float> row(static_cast<std::size_t>(scene.probe.lines));
  Imf::FrameBuffer buffer;
  buffer.insert("display.Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(row.data()), 4, 0));
  in.setFrameBuffer(buffer);
  for (int y = 0; y < scene.probe.samples; ++y) {
    in.readPixels(y);
    for (int x = 0; x < scene.probe.lines; ++x) {
      const float v = values[static_cast<std::size_t>(x * scene.probe.samples + y)];
      ASSERT_NEAR(row[static_cast<std::size_t>(x)], v, 0x1p-11f * v + 0x1p-24f) << x << "," << y;
    }
  }
}

TEST_F(ExrStackTest, ResumeTakesNoFileWithAnImpossibleValue) {
  values[4] = 1.0f;
  scene.output.channels = {Channel::y};
  stack().write(record, planes());
  std::string bytes = test::bytesOf(file());
  // Uncompressed, the last pixel ends the file.
  bytes.replace(bytes.size() - 4, 4, std::string("\x00\x00\xc0\x7f", 4));
  test::putBytes(file(), bytes);
  EXPECT_EQ(stack().existing(record), "");
}

TEST_F(ExrStackTest, ResumeRendersAgainWhatDiffersWithinTheScene) {
  stack().write(record, planes());
  std::filesystem::copy_file(file(), folder / "frame_0008.exr");
  EXPECT_EQ(stack().existing({8, 0.16, 0.17}), "") << "a copy under another frame's name";

  const ExrStack other_reference(folder.path(), scene, hash, 0.25);
  EXPECT_EQ(other_reference.existing(record), "");

  Scene other = scene;
  other.probe.samples += 1;
  EXPECT_EQ(ExrStack(folder.path(), other, hash, 0.125).existing(record), "");

  other = scene;
  other.output.channels = {Channel::y};
  EXPECT_EQ(ExrStack(folder.path(), other, hash, 0.125).existing(record), "");
}

TEST_F(ExrStackTest, ResumeStopsAtAWholeFileOfAnotherSceneOfAnySize) {
  Scene other = scene;
  for (const int samples : {scene.probe.samples, scene.probe.samples + 30}) {
    other.probe.samples = samples;
    std::vector<float> plane(static_cast<std::size_t>(other.probe.lines * samples), 1.0f);
    other.output.channels = {Channel::y};
    ExrStack(folder.path(), other, std::string(64, 'b'), 0.125)
        .write(record, {{Channel::y, plane, {}}});
    const std::string message = messageOf<SceneError>([&] { stack().existing(record); });
    EXPECT_NE(message.find("frame_0007.exr: "), std::string::npos) << message;
    EXPECT_NE(message.find("choose another folder or render without --resume"), std::string::npos)
        << message;
    const std::string whole = test::bytesOf(file());
    test::putBytes(file(), whole.substr(0, whole.size() / 2));
    EXPECT_EQ(stack().existing(record), "") << "cut short it is nobody's";
  }
}

}  // namespace
}  // namespace echocine
