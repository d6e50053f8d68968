#include "video/dicom_check.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's own order of includes: osconfig.h first.
#include <dcmtk/dcmdata/dcxfer.h>
#include <fmt/format.h>
#include <zlib.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "core/error.h"
#include "video/dicom_elements.h"
#include "video/video_builder.h"

namespace echocine {

namespace {

constexpr std::size_t kMaxInflatedBytes = std::size_t{1} << 28;

// PS3.5 A.5: raw deflate, no header. Refuses more than the limit without having it in memory twice.
std::vector<std::byte> inflated(const std::string& name, std::span<const std::byte> bytes) {
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, int (*)(z_stream*)> ends(&stream, inflateEnd);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());  // files are under 2^32 bytes
  std::vector<std::byte> out, block(1 << 20);
  int state = Z_OK;
  while (state == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(block.data());
    stream.avail_out = static_cast<uInt>(block.size());
    state = inflate(&stream, Z_NO_FLUSH);
    const std::size_t made = block.size() - stream.avail_out;
    if (out.size() + made > kMaxInflatedBytes)
      refuseDicom(
          name,
          fmt::format(
              "its deflated data set is over {} MB; give it uncompressed, or a shorter part of it",
              kMaxInflatedBytes >> 20));
    out.insert(out.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(made));
    if (made == 0 && stream.avail_in == 0) break;
  }
  if (state != Z_STREAM_END && state != Z_OK && state != Z_BUF_ERROR)
    refuseDicom(name, "a damaged DICOM file (its deflated data set); copy the file again");
  return out;
}

void checkNesting(const std::string& name, std::span<const std::byte> data,
                  const DicomSyntax& syntax) {
  DicomElements elements(data, syntax);
  while (elements.next()) {
  }
  if (elements.tooDeep())
    refuseDicom(name,
                fmt::format("its sequences are nested deeper than {}; give an ultrasound loop as a "
                            "scanner writes it",
                            kMaxDicomDepth));
  if (elements.unknownType())
    refuseDicom(name, "a damaged DICOM file (an element of unknown type); copy the file again");
  if (elements.lost()) refuseDicom(name, "a truncated or damaged DICOM file; copy the file again");
}

}  // namespace

void refuseDicom(const std::string& name, const std::string& what) {
  throw SceneError(fmt::format("{}: {}", name, what));
}

DicomMeta checkDicomStructure(const std::string& name, std::span<const std::byte> bytes) {
  DicomMeta meta = readDicomMeta(name, bytes);
  const std::span<const std::byte> data = bytes.subspan(meta.data_at);
  const DcmXfer coding(meta.transfer_syntax.c_str());
  if (coding.getStreamCompression() != ESC_none) {
    checkNesting(name, inflated(name, data), {});
  } else {
    checkNesting(name, data, {coding.isExplicitVR() == OFTrue, coding.isBigEndian() == OFTrue});
  }
  return meta;
}

}  // namespace echocine
