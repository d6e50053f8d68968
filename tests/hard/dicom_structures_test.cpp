// DICOM files that lie about their structure are refused before anything is decoded: wild RLE
// headers, nested sequences, deflated nothing, sizes and times that no file holds.

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstdlib>

#include "core/error.h"
#include "core/hash_random.h"
#include "support/dicom_bytes.h"
#include "support/run_program.h"
#include "video/read_video.h"

namespace echocine {
namespace {

using namespace support;

constexpr int kSide = 32;

std::string refusal(const std::string& bytes) {
  try {
    readVideoBytes("loop.dcm", std::as_bytes(std::span(bytes)));
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

std::string rleFile(const std::vector<std::string>& frames, int rows = kSide, int columns = kSide) {
  return dicomFile(
      kRle, dicomPicture(rows, columns, static_cast<int>(frames.size())) + dicomFragments(frames));
}

std::vector<std::string> soundFrames(int frames) {
  std::vector<std::string> all;
  for (int f = 0; f < frames; ++f)
    all.push_back(rleFrame(kSide * kSide, static_cast<char>(40 + 20 * f)));
  return all;
}

TEST(DicomStructures, SoundRleIsRead) {
  EXPECT_EQ(refusal(rleFile(soundFrames(3))), "");
}

// Random numbers in the header of one frame: refused or read, never followed out of the file.
TEST(DicomStructures, WildRleHeadersAreNeverFollowed) {
  const char* wanted = std::getenv("ECHOCINE_DICOM_CASES");
  const std::uint64_t cases = wanted ? std::strtoull(wanted, nullptr, 10) : 400;
  int refused = 0;
  for (std::uint64_t c = 0; c < cases; ++c) {
    std::vector<std::string> frames = soundFrames(3);
    std::string& frame = frames[c % 3];
    for (std::uint64_t k = 0; k <= c % 4; ++k) {
      const std::uint64_t hash = hashOf(c, k);
      const std::size_t at = 4 * (hash % 16);
      const std::uint32_t wild[] = {
          static_cast<std::uint32_t>(hash >> 32),       0xffffffff, 0x7fffffff,
          static_cast<std::uint32_t>(hash >> 40) % 200, 16,         0};
      frame.replace(at, 4, littleEndian(wild[hash / 16 % 6], 4));
    }
    if (hashOf(c, 9) % 4 == 0) frame.resize(hashOf(c, 10) % frame.size());
    refused += refusal(rleFile(frames)).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, static_cast<int>(cases / 4));
}

std::string nested(int depth, bool explicit_vr, bool lengths) {
  std::string inside;
  if (lengths) {
    for (int i = 0; i < depth; ++i) {
      inside = dicomTag(0xfffee000) + littleEndian(static_cast<std::uint32_t>(inside.size()), 4) +
               inside;
      inside = explicit_vr
                   ? dicomElement(0x00186011, "SQ", inside)
                   : dicomTag(0x00186011) +
                         littleEndian(static_cast<std::uint32_t>(inside.size()), 4) + inside;
    }
    return inside;
  }
  for (int i = 0; i < depth; ++i)
    inside += (explicit_vr ? dicomElement(0x00186011, "SQ", "", 0xffffffff)
                           : dicomTag(0x00186011) + littleEndian(0xffffffff, 4)) +
              dicomTag(0xfffee000) + littleEndian(0xffffffff, 4);
  return inside;
}

TEST(DicomStructures, DeeplyNestedSequencesAreRefusedOfEveryKind) {
  for (const bool explicit_vr : {true, false})
    for (const bool lengths : {true, false})
      for (const int depth : {33, 7000, 50000}) {
        if (lengths && depth > 7000) continue;  // quadratic to put together
        const std::string file = dicomFile(explicit_vr ? kExplicitLittle : kImplicitLittle,
                                           nested(depth, explicit_vr, lengths));
        EXPECT_NE(refusal(file).find("nested deeper"), std::string::npos)
            << depth << explicit_vr << lengths << refusal(file);
      }
  const std::string shallow =
      dicomFile(kExplicitLittle, nested(8, true, true) + dicomPicture(kSide, kSide, 1));
  EXPECT_EQ(refusal(shallow).find("nested deeper"), std::string::npos);
}

// Within 10 s of CPU and, ASan apart, 2 GB of addresses of which the libraries take half.
void expectCheapRefusal(const std::string& bytes, const char* says) {
  const TempFolder folder;
  const std::filesystem::path file = folder.write("loop.dcm", bytes);
#ifdef ECHOCINE_SANITIZED
  const std::string limit = "ulimit -t 60; ";
#else
  const std::string limit = "ulimit -t 10; ulimit -v 3000000; ";
#endif
  const Outcome outcome = runShell(limit + "%B compare '" + file.string() + "' '" + file.string() +
                                   "' -o '" + (folder / "out").string() + "' --threads 1");
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(DicomStructures, ADeflatedNothingOfGigabytesIsRefusedCheaply) {
  const std::string zeros(std::size_t{1} << 26, '\0');
  std::string data = dicomElement(0x00091001, "OB", "", 0xf0000000);
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
  std::string out(8 << 20, '\0');
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  stream.next_in = reinterpret_cast<Bytef*>(data.data());
  stream.avail_in = static_cast<uInt>(data.size());
  deflate(&stream, Z_NO_FLUSH);
  for (int i = 0; i < 10; ++i) {
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(zeros.data()));
    stream.avail_in = static_cast<uInt>(zeros.size());
    deflate(&stream, i < 9 ? Z_NO_FLUSH : Z_FINISH);
  }
  out.resize(stream.total_out);
  deflateEnd(&stream);
  expectCheapRefusal(dicomFile(kDeflated, out), "deflated data set is over 256 MB");
}

TEST(DicomStructures, SizesThatTheBytesCannotHoldAreRefusedCheaply) {
  std::vector<std::string> frames = soundFrames(48);
  expectCheapRefusal(rleFile(frames, 256, 65535), "cannot hold them");
  expectCheapRefusal(
      dicomFile(kExplicitLittle, dicomPicture(kSide, 65535, 1) +
                                     dicomElement(0x7fe00010, "OB", std::string(kSide * 65535, 7))),
      "accepted: up to 8192 a side");
  expectCheapRefusal(rleFile(frames, 2048, 4096), "cannot hold them");
  expectCheapRefusal(dicomFile(kRle, dicomPicture(kSide, kSide, 900000) + dicomFragments(frames)),
                     "cannot hold them");
}

// A file whose meta information is put together by hand: what the group length states, then
// elements.
std::string fileOfMeta(std::uint32_t length, const std::string& meta, const std::string& data) {
  std::string file(128, '\0');
  file += "DICM";
  file += dicomElement(0x00020000, "UL", littleEndian(length, 4));
  return file + meta + data;
}

std::string wildRle() {
  std::vector<std::string> frames = soundFrames(3);
  frames[1].replace(4, 4, littleEndian(0x7fffffff, 4));
  return dicomPicture(kSide, kSide, 3) + dicomFragments(frames);
}

// The guards follow the transfer syntax, so it must not be possible to hide it from them.
TEST(DicomStructures, AMetaHeaderThatCanBeReadInTwoWaysIsRefused) {
  const std::string rle = dicomElement(0x00020010, "UI", kRle),
                    plain = dicomElement(0x00020010, "UI", kExplicitLittle),
                    foreign = dicomElement(0x00090010, "LO", "ACME"),
                    later = dicomElement(0x00030010, "LO", "ACME"),
                    sequence = dicomElement(0x00020102, "SQ", ""),
                    odd_type = dicomElement(0x00020102, "QQ", "abcd");
  const auto size = [](const std::string& meta) { return static_cast<std::uint32_t>(meta.size()); };
  struct Case {
    const char* name;
    std::uint32_t length;
    std::string meta;
  };
  const std::vector<Case> cases = {
      {"a foreign element before the syntax", size(foreign + rle), foreign + rle},
      {"the same, the length of the syntax alone", size(rle), foreign + rle},
      {"the same, no length", 0, foreign + rle},
      {"a later group before the syntax", size(later + rle), later + rle},
      {"a foreign element after the syntax", size(rle + foreign), rle + foreign},
      {"too short a length", size(rle) - 4, rle},
      {"a length without the syntax", 0, rle},
      {"too long a length", size(rle) + 20, rle},
      {"a length beyond the file", 0x7fffffff, rle},
      {"two syntaxes", size(plain + rle), plain + rle},
      {"the same syntax twice, the second beyond the length", size(plain), plain + rle},
      {"no syntax", size(odd_type), odd_type},
      {"no elements", 0, ""},
      {"an empty syntax", 8, dicomElement(0x00020010, "UI", "")},
      {"a sequence", size(sequence + rle), sequence + rle},
      {"an unknown type", size(odd_type + rle), odd_type + rle}};
  for (const Case& c : cases)
    EXPECT_NE(refusal(fileOfMeta(c.length, c.meta, wildRle())).find("its file meta information"),
              std::string::npos)
        << c.name << ": " << refusal(fileOfMeta(c.length, c.meta, wildRle()));
  EXPECT_NE(refusal(fileOfMeta(size(rle), rle, wildRle())).find("RLE header"), std::string::npos);
  // Some exporters leave the length out: the group ends where another begins.
  const std::string sound = fileOfMeta(0, rle, "");
  const std::string without = std::string(sound).erase(132, 12);
  EXPECT_NE(refusal(without + wildRle()).find("RLE header"), std::string::npos);
  EXPECT_EQ(refusal(without + dicomPicture(kSide, kSide, 3) + dicomFragments(soundFrames(3))), "");
}

TEST(DicomStructures, UnknownSyntaxesAndTypesAreRefused) {
  EXPECT_NE(refusal(dicomFile("1.2.3.4", wildRle())).find("\"1.2.3.4\" is not known"),
            std::string::npos);
  EXPECT_NE(refusal(dicomFile("1.2\n", wildRle())).find("states no transfer syntax"),
            std::string::npos);
  EXPECT_NE(refusal(dicomFile(kExplicitLittle, dicomElement(0x00091001, "zz", "abcd") +
                                                   dicomPicture(kSide, kSide, 1)))
                .find("unknown type"),
            std::string::npos);
}

// Fragments under a syntax that has none: the RLE decoder is not asked, and nothing is made up.
TEST(DicomStructures, FragmentsUnderAnUncompressedSyntaxAreRefused) {
  for (const std::string& syntax : {kExplicitLittle, kDeflated}) {
    const std::string text = refusal(dicomFile(syntax, wildRle()));
    EXPECT_FALSE(text.empty());
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 0);
  }
}

TEST(DicomStructures, TimesThatNoScannerHasAreToldAndLeftOut) {
  for (const char* frame_time : {"1e300", "1e-300", "-5", "nan"}) {
    std::string picture = dicomPicture(kSide, kSide, 3);
    const std::string stated = dicomElement(0x00181063, "DS", "20");
    picture.replace(picture.find(stated), stated.size(),
                    dicomElement(0x00181063, "DS", frame_time));
    const std::string file = dicomFile(kRle, picture + dicomFragments(soundFrames(3)));
    const Video video = readVideoBytes("loop", std::as_bytes(std::span(file)));
    EXPECT_EQ(video.rate.hz, 0) << frame_time;
  }
}

}  // namespace
}  // namespace echocine
