// The containers that datasets are written in: the same bytes every time, as their formats ask.

#include <gtest/gtest.h>

#include "dataset/ustar.h"
#include "hdf/hdf5_file.h"
#include "support/temp_folder.h"

namespace echocine::dataset {
namespace {

using support::bytesOf;

TEST(DatasetFiles, Hdf5HasItsSignatureAndNoTimes) {
  const std::vector<std::uint8_t> pixels(2 * 3 * 4, 7);
  const std::vector<float> places(2 * 5 * 2, 0.5f);
  const Hdf5Array arrays[] = {{"frames", {2, 3, 4}, std::span<const std::uint8_t>(pixels), true},
                              {"meshes", {2, 5, 2}, std::span<const float>(places)}};
  const std::vector<std::byte> bytes = hdf5Bytes(arrays);
  ASSERT_GT(bytes.size(), 8u);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), 8), "\x89HDF\r\n\x1a\n");
  EXPECT_EQ(hdf5Bytes(arrays), bytes);
}

// Offsets are those of IEEE Std 1003.1, pax: name, size, sum, magic.
TEST(DatasetFiles, TarsHaveHeadersOfTheStandardAndWholeBlocks) {
  const support::TempFolder folder;
  const std::string text(600, 'x');
  UstarFile tar(folder / "a.tar");
  tar.add("ec000001_a4c.json", std::as_bytes(std::span(text)));
  EXPECT_EQ(tar.bytes(), 512u + 1024u);
  EXPECT_EQ(tar.bytes(), ustarBytes(text.size()));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.tar"));  // until it is whole
  tar.finish();
  const std::string bytes = bytesOf(folder / "a.tar");
  EXPECT_EQ(bytes.size(), 10240u);
  EXPECT_EQ(std::string(bytes.c_str()), "ec000001_a4c.json");
  EXPECT_EQ(bytes.substr(124, 11), "00000001130");  // 600 in octal
  EXPECT_EQ(bytes.substr(136, 11), "00000000000");  // its time
  EXPECT_EQ(bytes.substr(257, 8), std::string("ustar\0"
                                              "00",
                                              8));
  unsigned sum = 8 * ' ';
  for (std::size_t i = 0; i < 512; ++i)
    if (i < 148 || i >= 156) sum += static_cast<unsigned char>(bytes[i]);
  EXPECT_EQ(std::stoul(bytes.substr(148, 6), nullptr, 8), sum);
  EXPECT_EQ(bytes.substr(512, 600), text);
  EXPECT_EQ(bytes.find_first_not_of('\0', 1112), std::string::npos);
}

}  // namespace
}  // namespace echocine::dataset
