#include "video/dicom_header.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's own order of includes: osconfig.h first.
#include <dcmtk/dcmdata/dcostrmb.h>
#include <dcmtk/dcmdata/dctk.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "scene/scan_geometry.h"
#include "signal/picture.h"
#include "video/dicom_dictionary.h"
#include "video/dicom_put.h"
#include "video/dicom_uid.h"

namespace echocine {

using namespace dicom;

namespace {

// As many digits as a decimal string holds: 16 characters.
std::string decimalString(double value) {
  for (int digits = 16;; --digits) {
    std::string text = fmt::format("{:.{}g}", value, digits);
    if (text.size() <= 16) return text;
  }
}

// Whole numbers of a positive rate.
std::string wholeString(double value) {
  return fmt::format("{:.0f}", std::max(1.0, std::round(value)));
}

struct Code {
  const char* value;
  const char* meaning;
  const char* scheme = "SCT";  // SNOMED CT
};

// Echocardiography views: PS3.16, context groups 12226 and 12343. The short axis near the apex has
// no code of its own, so it takes that of all short axes.
Code viewCode(View view) {
  switch (view) {
    case View::a4c:
      return {"399214001", "Apical four chamber"};
    case View::a2c:
      return {"399232001", "Apical two chamber"};
    case View::a3c:
      return {"399339008", "Apical long axis"};
    case View::plax:
      return {"399139001", "Parasternal long axis"};
    case View::psax_base:
      return {"399239005", "Parasternal short axis at the aortic valve level"};
    case View::psax_mid:
      return {"399271003", "Parasternal short axis at the Papillary Muscle level"};
    case View::psax_apex:
      return {"399306005", "Parasternal short axis"};
    case View::subcostal:
      return {"399310008", "Subcostal long axis"};
    case View::tee_4c:
      return {"131100", "Mid-esophageal 0 degree TEE", "DCM"};
  }
  return {"", ""};
}

void putCode(DcmItem& to, const DcmTagKey& sequence, const Code& code) {
  DcmItem& item = addItem(to, sequence);
  put(item, DCM_CodeValue, EVR_SH, code.value);
  put(item, DCM_CodingSchemeDesignator, EVR_SH, code.scheme);
  put(item, DCM_CodeMeaning, EVR_LO, code.meaning);
}

// Patient, study, series and equipment. Elements that must be there and have no value are empty.
void putOrigin(DcmItem& data, const DicomLoop& loop) {
  const std::string& hash = loop.scene_sha256;
  const std::string& exam = loop.examination_sha256.empty() ? hash : loop.examination_sha256;
  put(data, DCM_SOPClassUID, EVR_UI, UID_UltrasoundMultiframeImageStorage);
  put(data, DCM_SOPInstanceUID, EVR_UI,
      dicomUid(fmt::format("instance {} {} {}", hash, loop.first_frame, loop.frames)));
  put(data, DCM_StudyInstanceUID, EVR_UI, dicomUid("study " + exam));
  put(data, DCM_SeriesInstanceUID, EVR_UI, dicomUid("series " + hash));
  put(data, DCM_PatientName, EVR_PN, "Synthetic^EchoCine");
  put(data, DCM_PatientID, EVR_LO, "ECHOCINE-" + exam.substr(0, 16));
  put(data, DCM_PatientBirthDate, EVR_DA, "");
  put(data, DCM_PatientSex, EVR_CS, "");
  put(data, DCM_StudyDate, EVR_DA, "");
  put(data, DCM_StudyTime, EVR_TM, "");
  put(data, DCM_AccessionNumber, EVR_SH, "");
  put(data, DCM_ReferringPhysicianName, EVR_PN, "");
  put(data, DCM_StudyID, EVR_SH, exam.substr(0, 16));
  put(data, DCM_Modality, EVR_CS, "US");
  put(data, DCM_SeriesNumber, EVR_IS, "1");
  put(data, DCM_InstanceNumber, EVR_IS, "1");
  put(data, DCM_PatientOrientation, EVR_CS, "");
  put(data, DCM_Manufacturer, EVR_LO, "EchoCine");
  put(data, DCM_SoftwareVersions, EVR_LO, ECHOCINE_VERSION);
  put(data, DCM_SeriesDescription, EVR_LO, "Simulated echocardiogram");
  put(data, DCM_ContentQualification, EVR_CS, "RESEARCH");
}

void putPixelFormat(DcmItem& data, const OutputSettings& output) {
  const bool plain = isPlainDicom(output);
  putShort(data, DCM_SamplesPerPixel, 3);
  put(data, DCM_PhotometricInterpretation, EVR_CS, plain ? "RGB" : "YBR_FULL_422");
  putShort(data, DCM_PlanarConfiguration, 0);
  putShort(data, DCM_Rows, output.height);
  putShort(data, DCM_Columns, output.width);
  putShort(data, DCM_BitsAllocated, 8);
  putShort(data, DCM_BitsStored, 8);
  putShort(data, DCM_HighBit, 7);
  putShort(data, DCM_PixelRepresentation, 0);
  putShort(data, DCM_UltrasoundColorDataPresent, 0);
  put(data, DCM_BurnedInAnnotation, EVR_CS, "NO");  // of who the patient is
  put(data, DCM_LossyImageCompression, EVR_CS, plain ? "00" : "01");
  if (!plain) put(data, DCM_LossyImageCompressionMethod, EVR_CS, "ISO_10918_1");
}

void putTimes(DcmItem& data, const DicomLoop& loop) {
  constexpr std::size_t kMostWaves = 0xfffc / sizeof(Float32);  // lengths have 16 bits
  const Acquisition& a = loop.scene.acquisition;
  put(data, DCM_NumberOfFrames, EVR_IS, std::to_string(loop.frames));
  check(data.putAndInsertTagKey(DcmTag(DCM_FrameIncrementPointer, DcmVR(EVR_AT)), DCM_FrameTime));
  put(data, DCM_FrameTime, EVR_DS, decimalString(1e3 / a.frame_rate_hz));
  put(data, DCM_CineRate, EVR_IS, wholeString(a.frame_rate_hz));
  put(data, DCM_RecommendedDisplayFrameRate, EVR_IS, wholeString(a.frame_rate_hz));
  put(data, DCM_HeartRate, EVR_IS, wholeString(60 * a.heart_rate_hz));
  std::vector<Float32> waves_ms;
  for (const double wave_s : loop.r_waves_s)
    if (waves_ms.size() < kMostWaves) waves_ms.push_back(static_cast<Float32>(1e3 * wave_s));
  if (waves_ms.empty()) return;
  auto vector =
      std::make_unique<DcmFloatingPointSingle>(DcmTag(DCM_RWaveTimeVector, DcmVR(EVR_FL)));
  check(vector->putFloat32Array(waves_ms.data(), waves_ms.size()));
  check(data.insert(vector.get(), true));
  vector.release();
}

// One region (PS3.3 C.8.5.5): the box of the scan area, ends included. Its reference pixel, counted
// from the region's corner, holds the middle of the face, or the axis of a radial probe; physical
// values are those of the pixel's centre.
void putRegion(DcmItem& data, const Scene& scene) {
  constexpr int kTissue = 1, kPlane = 1, kCentimetres = 3;
  const PictureGeometry g = pictureGeometry(scene);
  const Box area = scanBox(scene.probe);
  const PixelPoint lo = pixelOf(g, area.lo), hi = pixelOf(g, area.hi);
  const auto pixel = [](double at, int count) {
    return std::clamp(static_cast<int>(std::floor(at)), 0, count - 1);
  };
  const int left = pixel(lo.x, scene.output.width), top = pixel(lo.y, scene.output.height);
  Probe middle = scene.probe;
  middle.lines = 1;
  const PixelPoint face =
      pixelOf(g, middle.isFullTurn() ? Vec3d{} : lineGeometry(middle, 0).origin);
  const double face_x = std::floor(face.x), face_y = std::floor(face.y);
  const double delta_cm = 100 * g.metres_per_pixel;
  DcmItem& region = addItem(data, DCM_SequenceOfUltrasoundRegions);
  putShort(region, DCM_RegionSpatialFormat, kPlane);
  putShort(region, DCM_RegionDataType, kTissue);
  putLong(region, DCM_RegionFlags, 0);
  putLong(region, DCM_RegionLocationMinX0, left);
  putLong(region, DCM_RegionLocationMinY0, top);
  putLong(region, DCM_RegionLocationMaxX1, pixel(std::ceil(hi.x) - 1, scene.output.width));
  putLong(region, DCM_RegionLocationMaxY1, pixel(std::ceil(hi.y) - 1, scene.output.height));
  putSigned(region, DCM_ReferencePixelX0, static_cast<int>(face_x) - left);
  putSigned(region, DCM_ReferencePixelY0, static_cast<int>(face_y) - top);
  putShort(region, DCM_PhysicalUnitsXDirection, kCentimetres);
  putShort(region, DCM_PhysicalUnitsYDirection, kCentimetres);
  putDouble(region, DCM_ReferencePixelPhysicalValueX, (face_x + 0.5 - face.x) * delta_cm);
  putDouble(region, DCM_ReferencePixelPhysicalValueY, (face_y + 0.5 - face.y) * delta_cm);
  putDouble(region, DCM_PhysicalDeltaX, delta_cm);
  putDouble(region, DCM_PhysicalDeltaY, delta_cm);
  putLong(region, DCM_TransducerFrequency,  // kHz
          static_cast<int>(std::lround(1e-3 * scene.probe.frequency_hz)));
  const std::string spacing_mm = decimalString(1e3 * g.metres_per_pixel);
  put(data, DCM_PixelSpacing, EVR_DS, spacing_mm + "\\" + spacing_mm);
}

// A few hundred bytes of text and at most 64 KB of R waves fit the buffer.
std::vector<std::byte> bytesOf(DcmFileFormat& file, E_TransferSyntax syntax) {
  std::vector<std::byte> room(std::size_t{1} << 18);
  DcmOutputBufferStream stream(room.data(), static_cast<offile_off_t>(room.size()));
  file.transferInit();
  const OFCondition written =
      file.write(stream, syntax, EET_ExplicitLength, nullptr, EGL_withoutGL, EPD_withoutPadding);
  file.transferEnd();
  check(written);
  void* start = nullptr;
  offile_off_t size = 0;
  stream.flushBuffer(start, size);
  room.resize(static_cast<std::size_t>(size));
  return room;
}

}  // namespace

bool isPlainDicom(const OutputSettings& output) {
  return output.codec == CineCodec::ffv1;
}

std::vector<std::byte> dicomHeader(const DicomLoop& loop) {
  loadDicomDictionary();
  const Scene& scene = loop.scene;
  DcmFileFormat file;
  DcmDataset& data = *file.getDataset();
  putOrigin(data, loop);
  // PS3.3 C.8.5.6.1.1: the kind of examination, and 1 for two-dimensional imaging.
  put(data, DCM_ImageType, EVR_CS,
      fmt::format("ORIGINAL\\PRIMARY\\{}\\0001", !loop.view                       ? ""
                                                 : isTransoesophageal(*loop.view) ? "TEE"
                                                                                  : "TTE"));
  putPixelFormat(data, scene.output);
  putTimes(data, loop);
  putRegion(data, scene);
  putCode(data, DCM_AnatomicRegionSequence, {"80891009", "Heart"});
  if (loop.view) putCode(data, DCM_ViewCodeSequence, viewCode(*loop.view));
  return bytesOf(file, isPlainDicom(scene.output) ? EXS_LittleEndianExplicit : EXS_JPEGProcess1);
}

}  // namespace echocine
