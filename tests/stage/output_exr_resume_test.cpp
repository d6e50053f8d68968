// Resuming takes the very frame it would write, renders again what is absent, damaged or different,
// and stops at another scene.

#include "output_exr_fixture.h"

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
