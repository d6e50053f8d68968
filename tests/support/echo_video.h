#pragma once
// Small echo loops drawn by hand, and files of every kind to put them in.

#include <dcmtk/config/osconfig.h>
// DCMTK's own order of includes: osconfig.h first.
#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmdata/dcrleerg.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpeg/djencode.h>
#include <dcmtk/dcmjpeg/djrplol.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/hash.h"
#include "core/hash_random.h"
#include "core/seal.h"
#include "echo/echo_loop.h"
#include "video/cine_writer.h"

namespace echocine::support {

// A sector with a beating ring of muscle, another wall below, and speckle that moves with nothing.
struct Drawing {
  int width = 320, height = 240, frames = 24;
  double frames_per_beat = 24, time_shift = 0;  // frames
  double shift_x = 0, shift_y = 0, scale = 1;   // of everything, about the picture's origin
  double gamma = 1, noise = 0;  // of the grey 0..1; standard deviation in grey levels
  std::uint64_t seed = 1;
  echo::Sector sector{160, 5, -0.7, 0.7, 12, 225};
};

inline double beatOfRing(double phase) {
  return std::cos(2 * 3.14159265358979323846 * phase) -
         0.3 * std::sin(4 * 3.14159265358979323846 * phase);
}

inline double ringGreyAtBeat(const Drawing& d, double x, double y, double beat) {
  if (!d.sector.contains(x, y)) return 0;
  const auto bump = [](double t) { return t * t < 40 ? std::exp(-t * t) : 0; };
  const auto size = [](double a, double b) { return std::sqrt(a * a + b * b); };
  const double u = x - 165, v = y - 115;
  const double ring = bump((size(u, 0.8 * v) - 45 - 8 * beat) / 7);
  const double wall = bump((y - 190 - 4 * beat + 0.002 * u * u) / 9);
  const double spot = bump(size(x - 120 + 5 * beat, y - 70) / 9);
  const double texture = 0.06 * std::sin(0.31 * x + 0.17 * y) * std::sin(0.23 * y - 0.11 * x);
  return std::clamp(0.12 + 0.75 * ring + 0.55 * wall + 0.6 * spot + texture, 0.0, 1.0);
}

inline double ringGrey(const Drawing& d, double x, double y, double phase) {
  return ringGreyAtBeat(d, x, y, beatOfRing(phase));
}

inline PixelPlane drawnFrame(const Drawing& d, int frame) {
  PixelPlane out;
  const double beat = beatOfRing((frame + d.time_shift) / d.frames_per_beat);
  for (int y = 0; y < d.height; ++y)
    for (int x = 0; x < d.width; ++x) {
      // Four points a pixel, so that edges are as smooth as a scanner's.
      double sum = 0;
      for (const double a : {0.25, 0.75})
        for (const double b : {0.25, 0.75})
          sum += 255 * std::pow(ringGreyAtBeat(d, (x + a - d.shift_x) / d.scale,
                                               (y + b - d.shift_y) / d.scale, beat),
                                d.gamma);
      sum /= 4;
      if (sum > 0 && d.noise > 0)
        sum +=
            d.noise * normalFromHashes(
                          hashOf(d.seed, std::uint64_t(frame), std::uint64_t(y * d.width + x), 1),
                          hashOf(d.seed, std::uint64_t(frame), std::uint64_t(y * d.width + x), 2));
      out.push_back(static_cast<std::uint8_t>(std::clamp(std::lround(sum), 0L, 255L)));
    }
  return out;
}

inline std::vector<PixelPlane> drawnLoop(const Drawing& d) {
  std::vector<PixelPlane> frames;
  for (int i = 0; i < d.frames; ++i) frames.push_back(drawnFrame(d, i));
  return frames;
}

inline echo::Sector placedSector(const Drawing& d) {
  echo::Sector s = d.sector;
  s.apex_x = s.apex_x * d.scale + d.shift_x;
  s.apex_y = s.apex_y * d.scale + d.shift_y;
  s.r_min *= d.scale;
  s.r_max *= d.scale;
  return s;
}

// A render's manifest, as far as it proves that the folder's cine.avi is its own.
inline void writeManifestOfCine(const std::filesystem::path& folder) {
  const std::string digest = sha256HexOfFile(folder / "cine.avi");
  std::ofstream(folder / "manifest.json")
      << sealed("{\n \"files\": {\n  \"cine.avi\": \"" + digest + "\"\n }\n}");
}

// FFV1 in AVI: every grey comes back as it was.
inline std::filesystem::path writeLossless(const std::filesystem::path& path,
                                           const std::vector<PixelPlane>& frames, int width,
                                           int height, double rate_hz = 25) {
  OutputSettings settings;
  settings.codec = CineCodec::ffv1;
  settings.width = width;
  settings.height = height;
  CineWriter writer(path, settings, rate_hz);
  for (const PixelPlane& f : frames)
    writer.add(encodeCineFrame({width, height, f}, settings.codec, 95));
  writer.finish();
  return path;
}

inline std::filesystem::path writeLossless(const std::filesystem::path& path, const Drawing& d,
                                           double rate_hz = 25) {
  return writeLossless(path, drawnLoop(d), d.width, d.height, rate_hz);
}

// Frames of three bytes a pixel, blue, green, red.
inline std::vector<cv::Mat> coloured(const std::vector<PixelPlane>& frames, int width, int height) {
  std::vector<cv::Mat> out;
  for (const PixelPlane& f : frames) {
    cv::Mat bgr;
    cv::cvtColor(cv::Mat(height, width, CV_8U, const_cast<std::uint8_t*>(f.data())), bgr,
                 cv::COLOR_GRAY2BGR);
    out.push_back(bgr);
  }
  return out;
}

inline void writePictures(const std::filesystem::path& folder, const std::vector<cv::Mat>& frames,
                          const char* extension) {
  std::filesystem::create_directories(folder);
  for (std::size_t i = 0; i < frames.size(); ++i)
    cv::imwrite((folder / ("frame_" + std::to_string(i) + extension)).string(), frames[i]);
}

enum class DicomKind { grey, rgb, palette, rle, jpeg_baseline, jpeg_lossless, ybr_422 };

// An ultrasound multi-frame file. `more` adds or changes tags before it is written.
inline void writeDicom(
    const std::filesystem::path& path, const std::vector<PixelPlane>& frames, int width, int height,
    DicomKind kind, const std::function<void(DcmDataset&)>& more = [](DcmDataset&) {}) {
  DJEncoderRegistration::registerCodecs();
  DJDecoderRegistration::registerCodecs();
  DcmRLEEncoderRegistration::registerCodecs();
  DcmFileFormat file;
  DcmDataset& data = *file.getDataset();
  char uid[100];
  data.putAndInsertString(DCM_SOPClassUID, UID_UltrasoundMultiframeImageStorage);
  data.putAndInsertString(DCM_SOPInstanceUID, dcmGenerateUniqueIdentifier(uid));
  const bool three =
      kind == DicomKind::rgb || kind == DicomKind::jpeg_baseline || kind == DicomKind::ybr_422;
  const bool palette = kind == DicomKind::palette;
  data.putAndInsertUint16(DCM_SamplesPerPixel, three ? 3 : 1);
  data.putAndInsertString(DCM_PhotometricInterpretation, kind == DicomKind::ybr_422 ? "YBR_FULL_422"
                                                         : three                    ? "RGB"
                                                         : palette ? "PALETTE COLOR"
                                                                   : "MONOCHROME2");
  if (three) data.putAndInsertUint16(DCM_PlanarConfiguration, 0);
  data.putAndInsertString(DCM_NumberOfFrames, std::to_string(frames.size()).c_str());
  data.putAndInsertUint16(DCM_Rows, static_cast<Uint16>(height));
  data.putAndInsertUint16(DCM_Columns, static_cast<Uint16>(width));
  for (const DcmTagKey& key : {DCM_BitsAllocated, DCM_BitsStored}) data.putAndInsertUint16(key, 8);
  data.putAndInsertUint16(DCM_HighBit, 7);
  data.putAndInsertUint16(DCM_PixelRepresentation, 0);
  data.putAndInsertString(DCM_FrameTime, "20");
  if (palette) {  // entry i is the grey 255 - i, so reading without the palette would show
    std::vector<Uint16> table(256), head{256, 0, 16};
    for (std::size_t i = 0; i < 256; ++i) table[i] = static_cast<Uint16>((255 - i) * 257);
    for (const DcmTagKey& key :
         {DCM_RedPaletteColorLookupTableDescriptor, DCM_GreenPaletteColorLookupTableDescriptor,
          DCM_BluePaletteColorLookupTableDescriptor})
      data.putAndInsertUint16Array(key, head.data(), 3);
    for (const DcmTagKey& key :
         {DCM_RedPaletteColorLookupTableData, DCM_GreenPaletteColorLookupTableData,
          DCM_BluePaletteColorLookupTableData})
      data.putAndInsertUint16Array(key, table.data(), 256);
  }
  std::vector<Uint8> bytes;
  for (const PixelPlane& f : frames)
    for (std::size_t p = 0; p < f.size(); ++p) {
      if (kind == DicomKind::ybr_422) {  // two pixels: Y Y Cb Cr
        bytes.push_back(f[p]);
        if (p % 2 == 1) bytes.insert(bytes.end(), {128, 128});
      } else {
        for (int s = 0; s < (three ? 3 : 1); ++s)
          bytes.push_back(palette ? static_cast<Uint8>(255 - f[p]) : f[p]);
      }
    }
  data.putAndInsertUint8Array(DCM_PixelData, bytes.data(), bytes.size());
  more(data);
  E_TransferSyntax syntax = EXS_LittleEndianExplicit;
  if (kind == DicomKind::rle) syntax = EXS_RLELossless;
  if (kind == DicomKind::jpeg_baseline) syntax = EXS_JPEGProcess1;
  if (kind == DicomKind::jpeg_lossless) syntax = EXS_JPEGProcess14SV1;
  if (syntax != EXS_LittleEndianExplicit) data.chooseRepresentation(syntax, nullptr);
  file.saveFile(path.c_str(), syntax);
}

}  // namespace echocine::support
