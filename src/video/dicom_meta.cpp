#include "video/dicom_meta.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's own order of includes: osconfig.h first.
#include <dcmtk/dcmdata/dcistrmb.h>
#include <dcmtk/dcmdata/dctk.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/error.h"
#include "video/dicom_check.h"
#include "video/dicom_elements.h"

namespace echocine {

namespace {

constexpr std::size_t kPreamble = 132;  // 128 bytes of anything, then "DICM"
constexpr std::uint32_t kGroupLength = 0x00020000, kTransferSyntax = 0x00020010;
constexpr std::uint32_t kMetaGroup = 2;

[[noreturn]] void refuseMeta(const std::string& name, const std::string& what) {
  refuseDicom(
      name, fmt::format("a damaged DICOM file: its file meta information {}; export the file again",
                        what));
}

std::uint32_t longNumber(const DicomElement& e) {
  std::uint32_t value = 0;
  for (std::size_t i = std::min<std::size_t>(e.value.size(), 4); i-- > 0;)
    value = value << 8 | static_cast<std::uint32_t>(e.value[i]);
  return value;
}

bool isUid(const std::string& text) {
  return !text.empty() && text.find_first_not_of(".0123456789") == std::string::npos;
}

// Elements of group 0002 up to the first of another group.
DicomMeta walkMeta(const std::string& name, std::span<const std::byte> bytes) {
  DicomElements elements(bytes.subspan(kPreamble), {});
  DicomMeta meta;
  std::optional<std::size_t> stated_end;
  meta.data_at = kPreamble;
  while (elements.nextTag().value_or(0) >> 16 == kMetaGroup) {
    const std::optional<DicomElement> e = elements.next();
    if (!e) break;
    if (e->depth > 0 || e->sequence) refuseMeta(name, "holds a sequence");
    meta.data_at = kPreamble + elements.position();
    if (e->tag == kGroupLength) stated_end = meta.data_at + longNumber(*e);
    if (e->tag != kTransferSyntax) continue;
    if (!meta.transfer_syntax.empty()) refuseMeta(name, "states two transfer syntaxes");
    meta.transfer_syntax = e->text(64);
  }
  if (elements.unknownType()) refuseMeta(name, "has an element of unknown type");
  if (!isUid(meta.transfer_syntax)) refuseMeta(name, "states no transfer syntax");
  if (stated_end && *stated_end != meta.data_at)
    refuseMeta(name, "is of another length than it states, or holds elements of another group");
  return meta;
}

DicomMeta libraryMeta(const std::string& name, std::span<const std::byte> bytes) {
  DcmInputBufferStream stream;
  stream.setBuffer(bytes.data(), static_cast<offile_off_t>(bytes.size()));
  stream.setEos();
  DcmMetaInfo info;
  info.transferInit();
  const OFCondition read = info.read(stream);
  info.transferEnd();
  if (read.bad() && read != EC_EndOfStream) refuseMeta(name, "cannot be read");
  OFString uid;
  info.findAndGetOFString(DCM_TransferSyntaxUID, uid);
  return {uid.c_str(), static_cast<std::size_t>(stream.tell())};
}

}  // namespace

DicomMeta readDicomMeta(const std::string& name, std::span<const std::byte> bytes) {
  const DicomMeta meta = walkMeta(name, bytes);
  // The walked elements contain no sequence, so the library does not recurse.
  const DicomMeta library = libraryMeta(name, bytes.first(meta.data_at));
  if (library.transfer_syntax != meta.transfer_syntax || library.data_at != meta.data_at)
    refuseMeta(name, "can be read in two ways");
  if (DcmXfer(meta.transfer_syntax.c_str()).getXfer() == EXS_Unknown)
    refuseDicom(name, fmt::format("transfer syntax \"{}\" is not known; give it uncompressed, RLE, "
                                  "or JPEG baseline or lossless",
                                  meta.transfer_syntax));
  return meta;
}

}  // namespace echocine
