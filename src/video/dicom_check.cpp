#include "video/dicom_check.h"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "video/dicom_elements.h"
#include "video/video_builder.h"

namespace echocine {

namespace {

constexpr std::size_t kMaxInflatedBytes = std::size_t{1} << 28;
// An RLE segment packs 128 bytes in 2, a block of baseline JPEG 64 pixels in a few bits. Our
// choice.
constexpr double kMostSamplesPerByte = 512;

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
      refuseDicom(name,
             fmt::format("its deflated data set is over {} MB; give it uncompressed, or a few "
                         "beats cut out of it",
                         kMaxInflatedBytes >> 20));
    out.insert(out.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(made));
    if (made == 0 && stream.avail_in == 0) break;
  }
  if (state != Z_STREAM_END && state != Z_OK && state != Z_BUF_ERROR)
    refuseDicom(name, "a damaged DICOM file (its deflated data set); copy the file again");
  return out;
}

// PS3.5 G.5: 64 bytes of header, a count of 1 to 15 segments and their offsets, rising from 64.
bool isSoundRle(std::span<const std::byte> frame) {
  std::array<std::uint32_t, 16> header{};
  if (frame.size() < sizeof header) return false;
  std::memcpy(header.data(), frame.data(), sizeof header);  // little-endian, as we are
  if (header[0] < 1 || header[0] > 15 || header[1] != sizeof header) return false;
  for (std::uint32_t s = 1; s <= header[0]; ++s) {
    const std::uint32_t end =
        s < header[0] ? header[s + 1] : static_cast<std::uint32_t>(frame.size());
    if (header[s] > end || end > frame.size()) return false;
  }
  return true;
}

struct Pixels {
  double rows = 0, columns = 0, samples = 1, frames = 1;
  std::size_t compressed_bytes = 0;
  bool encapsulated = false;
};

void takeFragment(const std::string& name, const DicomElement& e, bool rle, Pixels& pixels) {
  pixels.encapsulated = true;
  if (e.fragment == 0) return;  // the table of offsets
  pixels.compressed_bytes += e.value.size();
  if (rle && !isSoundRle(e.value))
    refuseDicom(name,
           fmt::format("a damaged DICOM file: the RLE header of fragment {} points outside its "
                       "{} bytes; copy the file again",
                       e.fragment, e.value.size()));
}

void takeNumber(const DicomElement& e, Pixels& pixels) {
  constexpr std::uint32_t kRows = 0x00280010, kColumns = 0x00280011, kSamples = 0x00280002,
                          kFrames = 0x00280008;
  if (e.tag == kRows) pixels.rows = e.shortNumber();
  if (e.tag == kColumns) pixels.columns = e.shortNumber();
  if (e.tag == kSamples) pixels.samples = e.shortNumber();
  if (e.tag == kFrames) pixels.frames = std::atof(e.text(16).c_str());
}

// Pixels that the compressed bytes cannot hold would only be made up, at the cost of real ones.
void checkRatio(const std::string& name, const Pixels& p) {
  if (!p.encapsulated) return;
  const double wanted = p.rows * p.columns * p.samples * p.frames;
  if (wanted > kMostSamplesPerByte * static_cast<double>(p.compressed_bytes) + (1 << 20))
    refuseDicom(name,
           fmt::format("a truncated or damaged DICOM file: {:.0f} pixel values are stated, its "
                       "{} bytes of pixels cannot hold them; copy the file again",
                       wanted, p.compressed_bytes));
}

void checkDataSet(const std::string& name, std::span<const std::byte> data,
                  const DicomSyntax& syntax, bool rle) {
  DicomElements elements(data, syntax);
  Pixels pixels;
  while (const std::optional<DicomElement> e = elements.next()) {
    if (e->depth > 0) continue;
    if (e->fragment >= 0)
      takeFragment(name, *e, rle, pixels);
    else
      takeNumber(*e, pixels);
  }
  if (elements.tooDeep())
    refuseDicom(name,
           fmt::format("its sequences are nested deeper than {}; give an ultrasound loop as a "
                       "scanner writes it",
                       kMaxDicomDepth));
  if (elements.lost()) refuseDicom(name, "a truncated or damaged DICOM file; copy the file again");
  checkRatio(name, pixels);
}

}  // namespace

void refuseDicom(const std::string& name, const std::string& what) {
  throw SceneError(fmt::format("{}: {}", name, what));
}

void checkDicomStructure(const std::string& name, std::span<const std::byte> bytes) {
  constexpr std::size_t kPreamble = 132;
  constexpr std::uint32_t kTransferSyntax = 0x00020010;
  std::string uid;
  DicomElements meta(bytes.subspan(kPreamble), {});
  std::size_t at = 0;
  while (const std::optional<DicomElement> e = meta.next()) {
    if (e->tag >> 16 != 2) break;  // the data set begins here
    if (e->tag == kTransferSyntax) uid = e->text(64);
    at = meta.position();
  }
  const std::span<const std::byte> data = bytes.subspan(kPreamble + at);
  if (uid == "1.2.840.10008.1.2.1.99") {
    const std::vector<std::byte> whole = inflated(name, data);
    return checkDataSet(name, whole, {}, false);
  }
  DicomSyntax syntax;
  syntax.explicit_vr = uid != "1.2.840.10008.1.2";
  syntax.big_endian = uid == "1.2.840.10008.1.2.2";
  checkDataSet(name, data, syntax, uid == "1.2.840.10008.1.2.5");
}

}  // namespace echocine
