#include "video/dicom_writer.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "core/check.h"
#include "core/error.h"

namespace echocine {

namespace {

constexpr std::uint64_t kMostPlainBytes = 0xfffffffe;  // the longest even length of 32 bits
constexpr std::uint32_t kStreamedLength = 0xffffffff;

std::uint64_t plainBytes(const OutputSettings& output, int frames) {
  return 3 * static_cast<std::uint64_t>(output.width) * static_cast<std::uint64_t>(output.height) *
         static_cast<std::uint64_t>(frames);
}

constexpr std::uint32_t kPixelTag = 0x7fe00010, kItemTag = 0xfffee000, kItemsEndTag = 0xfffee0dd;

void appendNumber(std::vector<std::byte>& bytes, std::uint32_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::byte>(value >> 8 * i & 0xff));
}

// Group first, then element.
void appendTag(std::vector<std::byte>& bytes, std::uint32_t tag) {
  appendNumber(bytes, tag >> 16, 2);
  appendNumber(bytes, tag & 0xffff, 2);
}

// PS3.5 A.4: an item of even length.
std::vector<std::byte> itemHeader(std::uint32_t tag, std::size_t length) {
  std::vector<std::byte> bytes;
  appendTag(bytes, tag);
  appendNumber(bytes, static_cast<std::uint32_t>(length), 4);
  return bytes;
}

// The header of the pixel data, and of compressed ones the table of offsets, which may be empty.
std::vector<std::byte> pixelHeader(const OutputSettings& output, int frames) {
  const bool plain = isPlainDicom(output);
  const std::uint64_t stated = plainBytes(output, frames);
  std::vector<std::byte> bytes;
  appendTag(bytes, kPixelTag);
  bytes.insert(bytes.end(), {std::byte{'O'}, std::byte{'B'}, std::byte{0}, std::byte{0}});
  appendNumber(bytes, plain ? static_cast<std::uint32_t>(stated + stated % 2) : kStreamedLength, 4);
  if (plain) return bytes;
  appendTag(bytes, kItemTag);
  appendNumber(bytes, 0, 4);
  return bytes;
}

}  // namespace

void refuseLargeDicom(const OutputSettings& output, int frames) {
  if (!output.dicom || !isPlainDicom(output) || plainBytes(output, frames) <= kMostPlainBytes)
    return;
  throw SceneError(fmt::format(
      "output.dicom: {} frames of {} x {} pixels without compression need {:.1f} GB, a DICOM file "
      "holds 4.3 GB; use codec = \"mjpg\" or --frames",
      frames, output.width, output.height, 1e-9 * static_cast<double>(plainBytes(output, frames))));
}

DicomWriter::DicomWriter(std::filesystem::path path, DicomLoop loop)
    : path_(std::move(path)), loop_(std::move(loop)) {}

void DicomWriter::add(std::span<const std::byte> encoded_frame) {
  constexpr std::array kPad{std::byte{0}};
  const OutputSettings& output = loop_.scene.output;
  if (!file_) {
    const std::vector<std::byte> header = dicomHeader(loop_);
    file_.emplace(path_);
    file_->write(header);
    file_->write(pixelHeader(output, loop_.frames));
  }
  if (!isPlainDicom(output))
    file_->write(itemHeader(kItemTag, encoded_frame.size() + encoded_frame.size() % 2));
  file_->write(encoded_frame);
  if (!isPlainDicom(output) && encoded_frame.size() % 2 == 1) file_->write(kPad);
  ++frames_;
}

void DicomWriter::finish() {
  constexpr std::array kPad{std::byte{0}};
  CHECK_EQ(frames_, loop_.frames);
  const OutputSettings& output = loop_.scene.output;
  if (!isPlainDicom(output))
    file_->write(itemHeader(kItemsEndTag, 0));
  else if (plainBytes(output, frames_) % 2 == 1)
    file_->write(kPad);
  file_->finish();
}

}  // namespace echocine
