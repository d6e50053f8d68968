#include "output/exr_stack.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/file.h"
#include "core/hash.h"
#include "core/usable.h"
#include "output/exr_digest.h"
#include "output/exr_memory.h"
#include "output/half_plane.h"
#include "output/polar_plane.h"
#include "scene/names.h"
#include "scene/scan_geometry.h"
#include "video/cine_writer.h"

namespace echocine {
namespace {

// As many as a scene may ask for.
constexpr int kMostLines = 1 << 16, kMostSamples = 1 << 16;

Imf::Compression compressionOf(ExrCompression compression) {
  switch (compression) {
    case ExrCompression::rle:
      return Imf::RLE_COMPRESSION;
    case ExrCompression::zips:
      return Imf::ZIPS_COMPRESSION;
    case ExrCompression::zip:
      return Imf::ZIP_COMPRESSION;
    case ExrCompression::piz:
      return Imf::PIZ_COMPRESSION;
    case ExrCompression::pxr24:
      return Imf::PXR24_COMPRESSION;
    case ExrCompression::none:
      break;
  }
  return Imf::NO_COMPRESSION;
}

std::string probeJson(const Probe& probe) {
  const auto triple = [](Vec3d v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
  nlohmann::ordered_json json;
  json["kind"] = nameOf(probe.kind);
  json["apex_m"] = triple(probe.pose.origin);
  json["lateral"] = triple(probe.pose.x_axis);
  json["elevation"] = triple(probe.pose.y_axis);
  json["depth"] = triple(probe.pose.z_axis);
  const ScanGeometry geometry(probe);
  json["first_angle_rad"] = probe.isFan() ? geometry.firstPlace() : probe.first_angle_rad;
  json["last_angle_rad"] = probe.isFan() ? geometry.lastPlace() : probe.last_angle_rad;
  json["face_radius_m"] = probe.face_radius_m;
  json["first_offset_m"] = probe.first_offset_m;
  json["last_offset_m"] = probe.last_offset_m;
  json["min_depth_m"] = probe.min_depth_m;
  json["max_depth_m"] = probe.max_depth_m;
  return json.dump();
}

// Refused here, a bad value names its place; in the file it would only spoil whatever reads it.
void refuseUnusable(const FrameRecord& record, const ChannelPlane& plane, int samples) {
  if (isMotion(plane.channel)) return;  // may be negative, or unknown
  const std::optional<std::size_t> bad = firstUnusable(plane.values);
  if (!bad) return;
  const auto per_line = static_cast<std::size_t>(samples);
  throw JobError(fmt::format(
      "frame {}, line {}, sample {}: channel {} is {}: only finite values from 0 up are accepted",
      record.frame, *bad / per_line, *bad % per_line, channelName(plane.channel),
      plane.values[*bad]));
}

// Stores the planes as channels of the header and of the frame buffer; image takes the pixels.
Imf::FrameBuffer layOut(const std::vector<ChannelPlane>& planes, const Probe& probe, ExrPixel pixel,
                        std::uint32_t* image, Imf::Header& header) {
  const auto lines = static_cast<std::size_t>(probe.lines);
  const auto samples = static_cast<std::size_t>(probe.samples);
  Imf::FrameBuffer buffer;
  for (const ChannelPlane& plane : planes) {
    const bool ids = isLabel(plane.channel);
    if (ids)
      rowsFromLines(plane.ids, lines, samples, image);
    else
      rowsFromLines(plane.values, lines, samples, image);
    const bool half = !ids && !isMotion(plane.channel) && pixel == ExrPixel::half;
    if (half) {
      // Greys of 0 to 1 need no scale, and whoever knows of none reads them as they are.
      const bool scaled = plane.channel != Channel::display;
      const double scale = scaled ? halfScale(plane.values) : 1;
      narrowToHalf({image, lines * samples}, scale);
      if (scaled)
        header.insert(std::string("echocine:scale.") + channelName(plane.channel),
                      Imf::DoubleAttribute(scale));
    }
    const Imf::PixelType type = ids ? Imf::UINT : half ? Imf::HALF : Imf::FLOAT;
    const std::size_t size = half ? sizeof(std::uint16_t) : sizeof(std::uint32_t);
    header.channels().insert(channelName(plane.channel), Imf::Channel(type));
    buffer.insert(channelName(plane.channel),
                  Imf::Slice(type, reinterpret_cast<char*>(image), size, lines * size));
    image += lines * samples;
  }
  return buffer;
}

}  // namespace

ExrStack::ExrStack(std::filesystem::path folder, const Scene& scene, std::string scene_sha256,
                   double reference_intensity)
    : folder_(std::move(folder)),
      scene_(scene),
      scene_sha256_(std::move(scene_sha256)),
      reference_intensity_(reference_intensity),
      probe_json_(probeJson(scene.probe)) {
  // Frames are encoded in parallel; threads of the library's own would only compete with them.
  Imf::setGlobalThreadCount(0);
  // A damaged header met on resuming must not make the library ask for gigabytes.
  Imf::Header::setMaxImageSize(kMostLines, kMostSamples);
}

std::string ExrStack::fileName(int frame) {
  return fmt::format("frame_{:04}.exr", frame);
}

std::span<const std::byte> ExrStack::encode(const FrameRecord& record,
                                            const std::vector<ChannelPlane>& planes) const {
  const Probe& probe = scene_.probe;
  for (const ChannelPlane& plane : planes) refuseUnusable(record, plane, probe.samples);

  Imf::Header header(probe.lines, probe.samples, 1.0f, Imath::V2f(0, 0), 1.0f, Imf::INCREASING_Y,
                     compressionOf(scene_.output.exr_compression));
  const Rational rate = rationalFrameRate(scene_.acquisition.frame_rate_hz);
  Imf::addFramesPerSecond(header,
                          Imf::Rational(rate.numerator, static_cast<unsigned>(rate.denominator)));
  header.insert("echocine:time_s", Imf::DoubleAttribute(record.time_s));
  header.insert("echocine:phase", Imf::DoubleAttribute(record.phase));
  header.insert("echocine:frame", Imf::IntAttribute(record.frame));
  header.insert("echocine:probe", Imf::StringAttribute(probe_json_));
  header.insert("echocine:frequency_hz", Imf::DoubleAttribute(probe.frequency_hz));
  header.insert("echocine:scene_sha256", Imf::StringAttribute(scene_sha256_));
  header.insert("echocine:reference_intensity", Imf::DoubleAttribute(reference_intensity_));
  header.insert("echocine:version", Imf::StringAttribute(ECHOCINE_VERSION));
  header.insert(kExrDigestName, Imf::StringAttribute(emptyExrDigest()));

  const std::filesystem::path path = folder_ / fileName(record.frame);
  const std::size_t pixels =
      static_cast<std::size_t>(probe.lines) * static_cast<std::size_t>(probe.samples);
  thread_local std::vector<std::uint32_t> image;
  thread_local std::vector<std::byte> bytes;
  image.resize(planes.size() * pixels);
  const Imf::FrameBuffer buffer =
      layOut(planes, probe, scene_.output.exr_pixel, image.data(), header);

  // Per sample row: its place in the table of offsets, its number and its size, 16 bytes together.
  const std::size_t around = 4096 + 16 * static_cast<std::size_t>(probe.samples);
  bytes.reserve(planes.size() * pixels * sizeof(std::uint32_t) + around);
  ExrMemory stream(path.string(), bytes);
  try {
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(probe.samples);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw JobError(fmt::format("{}: cannot be encoded: {}", path.string(), error.what()));
  }
  sealExr(bytes);
  return bytes;
}

std::string ExrStack::write(const FrameRecord& record,
                            const std::vector<ChannelPlane>& planes) const {
  const std::span<const std::byte> bytes = encode(record, planes);
  writeFileWhole(folder_ / fileName(record.frame), bytes);
  return sha256Hex(bytes);
}

PendingFile ExrStack::prepare(const FrameRecord& record, const std::vector<ChannelPlane>& planes,
                              std::string& sha256) const {
  const std::span<const std::byte> bytes = encode(record, planes);
  sha256 = sha256Hex(bytes);
  return {folder_ / fileName(record.frame), bytes};
}

}  // namespace echocine
