#pragma once
// DICOM files put together byte by byte, so that any of them may lie.

#include <cstdint>
#include <string>
#include <vector>

namespace echocine::support {

inline std::string littleEndian(std::uint32_t value, int size) {
  std::string bytes;
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
  return bytes;
}

inline std::string dicomTag(std::uint32_t tag) {
  return littleEndian(tag >> 16, 2) + littleEndian(tag & 0xffff, 2);
}

// An element of explicit type; `length` may be another than the value's.
inline std::string dicomElement(std::uint32_t tag, const std::string& vr, std::string value,
                                std::uint32_t length = 0xfffffffe) {
  if (value.size() % 2 == 1) value += vr == "UI" ? '\0' : ' ';
  if (length == 0xfffffffe) length = static_cast<std::uint32_t>(value.size());
  const bool wide = vr == "OB" || vr == "OW" || vr == "SQ" || vr == "UN";
  return dicomTag(tag) + vr +
         (wide ? std::string(2, '\0') + littleEndian(length, 4) : littleEndian(length, 2)) + value;
}

inline std::string dicomFile(const std::string& transfer_syntax, const std::string& data) {
  const std::string meta = dicomElement(0x00020010, "UI", transfer_syntax);
  std::string file(128, '\0');
  file += "DICM";
  file += dicomElement(0x00020000, "UL", littleEndian(static_cast<std::uint32_t>(meta.size()), 4));
  return file + meta + data;
}

inline const std::string kExplicitLittle = "1.2.840.10008.1.2.1",
                         kImplicitLittle = "1.2.840.10008.1.2",
                         kDeflated = "1.2.840.10008.1.2.1.99", kRle = "1.2.840.10008.1.2.5";

// Grey pictures of 8 bits; the pixel data follows.
inline std::string dicomPicture(int rows, int columns, int frames, const std::string& more = "") {
  const auto number = [](std::uint32_t tag, int value) {
    return dicomElement(tag, "US", littleEndian(static_cast<std::uint32_t>(value), 2));
  };
  return dicomElement(0x00181063, "DS", "20") + more + number(0x00280002, 1) +
         dicomElement(0x00280004, "CS", "MONOCHROME2") +
         dicomElement(0x00280008, "IS", std::to_string(frames)) + number(0x00280010, rows) +
         number(0x00280011, columns) + number(0x00280100, 8) + number(0x00280101, 8) +
         number(0x00280102, 7) + number(0x00280103, 0);
}

// Encapsulated pixels: an empty table of offsets, then the fragments.
inline std::string dicomFragments(const std::vector<std::string>& fragments) {
  const std::string item = dicomTag(0xfffee000);
  std::string bytes = dicomElement(0x7fe00010, "OB", "", 0xffffffff) + item + littleEndian(0, 4);
  for (std::string fragment : fragments) {
    if (fragment.size() % 2 == 1) fragment += '\0';
    bytes += item + littleEndian(static_cast<std::uint32_t>(fragment.size()), 4) + fragment;
  }
  return bytes + dicomTag(0xfffee0dd) + littleEndian(0, 4);
}

// One segment of RLE (PS3.5 G): runs of 128 equal bytes.
inline std::string rleFrame(int pixels, char grey) {
  std::string bytes = littleEndian(1, 4) + littleEndian(64, 4) + std::string(56, '\0');
  for (int left = pixels; left > 0; left -= 128) {
    const int run = left < 128 ? left : 128;
    bytes += static_cast<char>(run == 1 ? 0 : 257 - run);
    bytes += static_cast<char>(grey + left / 128 % 7);
  }
  return bytes;
}

}  // namespace echocine::support
