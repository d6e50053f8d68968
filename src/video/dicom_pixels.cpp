#include "video/dicom_pixels.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's own order of includes: osconfig.h first.
#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <dcmtk/dcmdata/dctk.h>
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <span>

#include "video/dicom_check.h"
#include "video/video_builder.h"

namespace echocine {

namespace {

// An RLE segment packs 128 bytes in 2, a block of baseline JPEG 64 pixels in a few bits. Our
// choice.
constexpr double kMostSamplesPerByte = 512;

struct Shape {
  Uint16 rows = 0, columns = 0, samples = 1, bits = 8;
};

// PS3.5 G.5: 64 bytes of header, a count of 1 to 15 segments and their offsets, rising from 64.
bool isSoundRle(std::span<const Uint8> frame) {
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

void checkRle(const std::string& name, DcmPixelSequence& fragments) {
  for (unsigned long f = 1; f < fragments.card(); ++f) {  // 0 is the table of offsets
    DcmPixelItem* item = nullptr;
    Uint8* bytes = nullptr;
    const bool read = fragments.getItem(item, f).good() && item->getUint8Array(bytes).good();
    const std::span<const Uint8> frame(bytes, read && bytes != nullptr ? item->getLength() : 0);
    if (!isSoundRle(frame))
      refuseDicom(name, fmt::format("a damaged DICOM file: the RLE header of fragment {} points "
                                    "outside its {} bytes; copy the file again",
                                    f, frame.size()));
  }
}

// Pixels that the compressed bytes cannot hold would only be made up, at the cost of real ones.
void checkEncapsulated(const std::string& name, const Shape& shape, std::int64_t frames,
                       E_TransferSyntax syntax, DcmPixelData& pixels) {
  E_TransferSyntax original = EXS_Unknown;
  const DcmRepresentationParameter* parameter = nullptr;
  DcmPixelSequence* fragments = nullptr;
  pixels.getOriginalRepresentationKey(original, parameter);
  if (pixels.getEncapsulatedRepresentation(original, parameter, fragments).bad() ||
      fragments == nullptr)
    refuseDicom(name,
                "a damaged DICOM file: its compressed pixels are no fragments; copy the file "
                "again");
  double bytes = 0;
  for (unsigned long f = 1; f < fragments->card(); ++f) {
    DcmPixelItem* item = nullptr;
    if (fragments->getItem(item, f).good()) bytes += item->getLength();
  }
  const double wanted =
      1.0 * shape.rows * shape.columns * shape.samples * static_cast<double>(frames);
  if (wanted > kMostSamplesPerByte * bytes + (1 << 20))
    refuseDicom(name, fmt::format("a truncated or damaged DICOM file: {:.0f} pixel values are "
                                  "stated, its {:.0f} bytes of pixels cannot hold them; copy the "
                                  "file again",
                                  wanted, bytes));
  if (syntax == EXS_RLELossless) checkRle(name, *fragments);
}

void checkPlain(const std::string& name, const Shape& shape, std::int64_t frames, DcmDataset& data,
                DcmElement& pixels) {
  OFString colours;
  data.findAndGetOFString(DCM_PhotometricInterpretation, colours);
  const double bytes_per_pixel =
      colours == "YBR_FULL_422" ? 2.0 : static_cast<double>(shape.samples) * ((shape.bits + 7) / 8);
  const double wanted = bytes_per_pixel * shape.rows * shape.columns * static_cast<double>(frames);
  if (pixels.getLength() < wanted)
    refuseDicom(name,
                fmt::format("a truncated DICOM file: {} bytes of pixels where {} frames of {} x {} "
                            "need {:.0f}; copy the file again",
                            pixels.getLength(), frames, shape.columns, shape.rows, wanted));
}

}  // namespace

void checkDicomPixels(const std::string& name, DcmDataset& data, std::int64_t frames) {
  Shape shape;
  data.findAndGetUint16(DCM_Rows, shape.rows);
  data.findAndGetUint16(DCM_Columns, shape.columns);
  data.findAndGetUint16(DCM_SamplesPerPixel, shape.samples);
  data.findAndGetUint16(DCM_BitsAllocated, shape.bits);
  DcmElement* element = nullptr;
  if (data.findAndGetElement(DCM_PixelData, element).bad() || shape.rows == 0 || shape.columns == 0)
    refuseDicom(name, "a DICOM file without pictures; give an ultrasound multi-frame file");
  const E_TransferSyntax syntax = data.getOriginalXfer();
  const bool encapsulated = DcmXfer(syntax).isEncapsulated();
  if (encapsulated) {
    auto* pixels = dynamic_cast<DcmPixelData*>(element);
    if (pixels == nullptr)
      refuseDicom(name, "a damaged DICOM file: its pixels are of another type");
    checkEncapsulated(name, shape, frames, syntax, *pixels);
  }
  // Before the decoder sees a byte: it reserves what a header says.
  checkLoopSize(name, shape.columns, shape.rows, frames);
  if (!encapsulated) checkPlain(name, shape, frames, data, *element);
}

}  // namespace echocine
