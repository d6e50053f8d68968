// Arrays for NumPy, byte by byte where the format says so.

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "output/npy.h"

namespace echocine {
namespace {

std::string textOf(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(TruthArrays, AnArrayHasItsHeaderAndItsValues) {
  const float values[] = {1, 2, 3, 4, 5, 6};
  const std::string file = textOf(npyBytes(values, {2, 3}));
  EXPECT_EQ(file.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t length =
      static_cast<unsigned char>(file[8]) + 256u * static_cast<unsigned char>(file[9]);
  EXPECT_EQ((10 + length) % 64, 0u);
  EXPECT_EQ(file[10 + length - 1], '\n');
  EXPECT_NE(file.find("'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, ), "),
            std::string::npos);
  ASSERT_EQ(file.size(), 10 + length + sizeof values);
  EXPECT_EQ(std::memcmp(file.data() + 10 + length, values, sizeof values), 0);
}

TEST(TruthArrays, AZipHoldsTheArraysUncompressedWithTheirChecks) {
  // The check value of CRC-32 is that of the nine digits.
  const std::string digits = "123456789";
  const auto* bytes = reinterpret_cast<const std::byte*>(digits.data());
  const NamedArray array{"digits", {bytes, bytes + digits.size()}};
  const std::string file = textOf(npzBytes(std::span(&array, 1)));
  EXPECT_EQ(file.substr(0, 4), "PK\x03\x04");
  EXPECT_EQ(file.substr(14, 4), "\x26\x39\xf4\xcb");
  EXPECT_EQ(file.substr(30, 10 + digits.size()), "digits.npy" + digits);
  EXPECT_EQ(file.substr(30 + 10 + digits.size(), 4), "PK\x01\x02");
  EXPECT_EQ(file.substr(file.size() - 22, 4), "PK\x05\x06");
}

}  // namespace
}  // namespace echocine
