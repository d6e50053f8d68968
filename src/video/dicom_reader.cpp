// DICOM ultrasound: multi-frame pixels of any transfer syntax that DCMTK decodes, and the tags that
// speak of time and scale.

#include <dcmtk/config/osconfig.h>
// DCMTK's own order of includes: osconfig.h first.
#include <dcmtk/dcmdata/dcistrmb.h>
#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmimage/diregist.h>
#include <dcmtk/dcmimgle/dcmimage.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/oflog/oflog.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <vector>

#include "core/error.h"
#include "video/dicom_check.h"
#include "video/dicom_dictionary.h"
#include "video/dicom_pixels.h"
#include "video/read_video.h"
#include "video/video_builder.h"

namespace echocine {

namespace {

// DCMTK keeps its decoders in global tables, which must not be filled twice.
void setUpOnce() {
  loadDicomDictionary();
  static std::once_flag once;
  std::call_once(once, [] {
    OFLog::configure(OFLogger::OFF_LOG_LEVEL);  // errors come back as values
    DJDecoderRegistration::registerCodecs();
    DcmRLEDecoderRegistration::registerCodecs();
  });
}

// 0 where the tag is absent or no number: none of the tags read here can be 0.
double numberOf(DcmItem& item, const DcmTagKey& key, unsigned long position = 0) {
  OFString text;
  if (item.findAndGetOFString(key, text, position).bad()) return 0;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end != text.c_str() && std::isfinite(value) ? value : 0;
}

// All values of a list. One by one the library would walk the list again for each.
std::vector<double> numbersOf(DcmItem& item, const DcmTagKey& key, std::size_t most) {
  OFString text;
  std::vector<double> values;
  if (item.findAndGetOFStringArray(key, text).bad()) return values;
  const char* at = text.c_str();
  while (values.size() < most) {
    char* end = nullptr;
    const double value = std::strtod(at, &end);
    values.push_back(end != at && std::isfinite(value) ? value : 0);
    at = std::strchr(end, '\\');
    if (at == nullptr) break;
    ++at;
  }
  return values;
}

// The rate, or the mean interval between R waves, ms. Impossible values give a warning and are
// omitted.
void takeHeartRate(DcmDataset& data, Video& video) {
  const auto take = [&](const DcmTagKey& key, const char* name, bool is_interval) {
    OFString text;
    if (video.heart_rate_bpm || data.findAndGetOFString(key, text).bad() || text.empty()) return;
    const double value = numberOf(data, key), bpm = is_interval ? 60e3 / value : value;
    if (bpm >= 10 && bpm <= 400) {
      video.heart_rate_bpm = bpm;
      video.heart_rate_source = fmt::format("DICOM {}", name);
    } else {
      std::string shown(text.c_str());
      for (char& c : shown)
        if (c < ' ' || c > '~') c = '?';  // of any character set
      video.notes.push_back(
          fmt::format("its {} tag says {}: not a heart rate, not used", name, shown));
    }
  };
  take(DCM_HeartRate, "HeartRate", false);
  take(DCM_NominalInterval, "NominalInterval", true);
}

// Impossible values give a warning and are omitted.
void takeRate(double hz, const char* source, Video& video) {
  if (video.rate.hz > 0 || !(hz > 0)) return;
  if (hz >= kLeastFrameRate_hz && hz <= kMostFrameRate_hz)
    video.rate = {hz, source, true};
  else
    video.notes.push_back(fmt::format("its {} tag means {:.3g} frames/s: not used", source, hz));
}

// The frame at a time, between two of them a fraction. `steps_ms`: from the frame before; the first
// is no step. Beyond the ends the first or last step goes on.
double frameAt(double ms, const std::vector<double>& steps_ms) {
  double start_ms = 0;
  std::size_t i = 1;
  while (i + 1 < steps_ms.size() && start_ms + steps_ms[i] <= ms) start_ms += steps_ms[i++];
  return static_cast<double>(i - 1) + (steps_ms[i] > 0 ? (ms - start_ms) / steps_ms[i] : 0);
}

void takeTimes(DcmDataset& data, Video& video) {
  constexpr std::size_t kMostSteps = 100000, kMostBeats = 1000;
  if (const double ms = numberOf(data, DCM_FrameTime); ms > 0)
    takeRate(1e3 / ms, "DICOM FrameTime", video);
  const std::vector<double> steps_ms = numbersOf(data, DCM_FrameTimeVector, kMostSteps);
  double sum_ms = 0, longest_ms = 0;
  for (std::size_t i = 1; i < steps_ms.size(); ++i) {
    sum_ms += steps_ms[i];
    longest_ms = std::max(longest_ms, steps_ms[i]);
  }
  if (steps_ms.size() > 1) {
    const double mean_ms = sum_ms / static_cast<double>(steps_ms.size() - 1);
    takeRate(1e3 / mean_ms, "DICOM FrameTimeVector", video);
    noteUnevenFrames(longest_ms, mean_ms, video);
  }
  takeRate(numberOf(data, DCM_CineRate), "DICOM CineRate", video);
  takeHeartRate(data, video);
  const std::vector<double> waves_ms = numbersOf(data, DCM_RWaveTimeVector, kMostBeats);
  if (!areAscending(waves_ms) || (!waves_ms.empty() && waves_ms.front() < 0)) {
    video.notes.emplace_back("its RWaveTimeVector tag has no ascending times: not used");
    return;
  }
  video.r_waves_by_frames = steps_ms.size() > 1 && video.rate.hz > 0;
  for (const double ms : waves_ms)
    video.r_waves_s.push_back(video.r_waves_by_frames ? frameAt(ms, steps_ms) / video.rate.hz
                                                      : 1e-3 * ms);
}

// At most 64 regions: a file may state any number of them.
void takeRegions(DcmDataset& data, Video& video) {
  DcmSequenceOfItems* regions = nullptr;
  if (data.findAndGetSequence(DCM_SequenceOfUltrasoundRegions, regions).bad()) return;
  for (unsigned long i = 0; i < std::min(regions->card(), 64UL); ++i) {
    DcmItem& item = *regions->getItem(i);
    const auto whole = [&](const DcmTagKey& key) {
      Uint32 value = 0;
      item.findAndGetUint32(key, value);
      return static_cast<int>(std::min<Uint32>(value, 1u << 24));
    };
    Uint16 units_x = 0, units_y = 0;
    Float64 dx = 0, dy = 0;
    item.findAndGetUint16(DCM_PhysicalUnitsXDirection, units_x);
    item.findAndGetUint16(DCM_PhysicalUnitsYDirection, units_y);
    item.findAndGetFloat64(DCM_PhysicalDeltaX, dx);
    item.findAndGetFloat64(DCM_PhysicalDeltaY, dy);
    UltrasoundRegion r{whole(DCM_RegionLocationMinX0),
                       whole(DCM_RegionLocationMinY0),
                       whole(DCM_RegionLocationMaxX1),
                       whole(DCM_RegionLocationMaxY1),
                       0,
                       0};
    constexpr Uint16 kCentimetres = 3;  // PS3.3 C.8.5.5.1.15
    if (units_x == kCentimetres && units_y == kCentimetres && std::isfinite(dx) &&
        std::isfinite(dy)) {
      r.cm_per_pixel_x = std::abs(dx);
      r.cm_per_pixel_y = std::abs(dy);
    }
    video.regions.push_back(r);
  }
}

void addFrames(DcmDataset& data, std::int64_t frames, VideoBuilder& builder) {
  const std::string& name = builder.video().name;
  const DcmXfer syntax(data.getOriginalXfer());
  for (std::int64_t i = 0; i < frames; ++i) {
    // One frame at a time: decoding all of a loop at once takes gigabytes.
    DicomImage image(&data, data.getOriginalXfer(), CIF_UsePartialAccessToPixelData,
                     static_cast<unsigned long>(i), 1);
    if (image.getStatus() != EIS_Normal) {
      if (i == 0)
        refuseDicom(name,
                    fmt::format("pixels of transfer syntax \"{}\" cannot be decoded ({}); give it "
                                "uncompressed, RLE, or JPEG baseline or lossless",
                                syntax.getXferName(), DicomImage::getString(image.getStatus())));
      refuseDicom(
          name, fmt::format("a truncated or damaged DICOM file: frame {} of {} cannot be decoded; "
                            "copy the file again",
                            i, frames));
    }
    const auto width = static_cast<int>(image.getWidth()),
               height = static_cast<int>(image.getHeight());
    checkLoopSize(name, width, height, frames);
    std::vector<std::uint8_t> rgb(3 * static_cast<std::size_t>(width) *
                                  static_cast<std::size_t>(height));
    if (image.isMonochrome()) {
      // The file's own window, the same in every frame; a window fitted to each would flicker.
      if (image.getWindowCount() == 0 || image.setWindow(0) == 0) image.setNoVoiTransformation();
      const std::size_t pixels = rgb.size() / 3;
      std::vector<std::uint8_t> grey(pixels);
      if (!image.getOutputData(grey.data(), grey.size(), 8))
        refuseDicom(name, "its grey levels cannot be read");
      for (std::size_t p = 0; p < pixels; ++p)
        rgb[3 * p] = rgb[3 * p + 1] = rgb[3 * p + 2] = grey[p];
    } else if (!image.getOutputData(rgb.data(), rgb.size(), 8)) {
      refuseDicom(name, "its colours cannot be read");
    }
    builder.add(rgb.data(), width, height, std::ptrdiff_t{3} * width);
  }
}

}  // namespace

Video readDicom(const std::string& name, std::span<const std::byte> bytes) {
  const DicomMeta meta = checkDicomStructure(name, bytes);
  setUpOnce();
  DcmInputBufferStream stream;
  stream.setBuffer(bytes.data(), static_cast<offile_off_t>(bytes.size()));
  stream.setEos();
  DcmFileFormat file;
  file.transferInit();
  const OFCondition read = file.read(stream);
  file.transferEnd();
  // A stream that ends within the pixels is found by their length, with a better message.
  if (read.bad() && read != EC_EndOfStream)
    refuseDicom(name, fmt::format("a truncated or damaged DICOM file ({}); copy the file again",
                                  read.text()));
  DcmDataset& data = *file.getDataset();
  // Guards followed the stated syntax; one that the library found by itself has none.
  if (data.getOriginalXfer() != DcmXfer(meta.transfer_syntax.c_str()).getXfer())
    refuseDicom(name,
                "a damaged DICOM file: its data set is not of the stated transfer syntax; "
                "export the file again");
  const double stated = numberOf(data, DCM_NumberOfFrames);
  // Over five hours at 50 frames/s.
  if (stated > 1e6)
    refuseDicom(name, fmt::format("{} frames are stated; give a few beats", stated));
  const auto frames = static_cast<std::int64_t>(std::max(1.0, stated));
  checkDicomPixels(name, data, frames);
  VideoBuilder builder(name);
  builder.expectBytes(bytes.size());
  builder.video().format = fmt::format("DICOM, {}", DcmXfer(data.getOriginalXfer()).getXferName());
  takeTimes(data, builder.video());
  takeRegions(data, builder.video());
  addFrames(data, frames, builder);
  return builder.finish();
}

}  // namespace echocine
