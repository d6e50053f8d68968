#include <fmt/format.h>
#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "core/check.h"
#include "video/cine_writer.h"
#include "video/dicom_writer.h"
#include "video/ffv1_encoder.h"
#include "video/libav_owner.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/opt.h>
}

namespace echocine {
namespace {

// Precondition of all encoders, which read width * height bytes.
void checkSize(const GreyImage& image) {
  CHECK_LT(0, image.width);
  CHECK_LT(0, image.height);
  CHECK_EQ(image.pixels.size(),
           static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
}

std::vector<std::byte> asBytes(const std::uint8_t* data, std::size_t size) {
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  return {bytes, bytes + size};
}

struct CompressorFree {
  void operator()(void* compressor) const { tjDestroy(compressor); }
};

// An image's rows as the library reads them: with subsampled chroma, an odd width or height has one
// more column or row, here the last one again. Valid until the thread's next call.
const std::uint8_t* lumaOf(const GreyImage& image, int width, int height) {
  if (width == image.width && height == image.height) return image.pixels.data();
  thread_local std::vector<std::uint8_t> padded;
  padded.clear();
  for (int y = 0; y < height; ++y) {
    const auto row =
        image.pixels.begin() + std::ptrdiff_t{std::min(y, image.height - 1)} * image.width;
    padded.insert(padded.end(), row, row + image.width);
    padded.resize(static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(width), padded.back());
  }
  return padded.data();
}

// Luma at full resolution, and empty chroma: players take a colour JPEG's range as 0 to 255, while
// FFmpeg reports an unknown range for a grey one. The accurate transform is used, because the fast
// one differs between processors, and the same scene must give the same bytes.
std::vector<std::byte> encodeJpeg(const GreyImage& image, int quality, TJSAMP layout) {
  const std::unique_ptr<void, CompressorFree> compressor(tjInitCompress());
  if (!compressor) throw std::bad_alloc();
  constexpr std::uint8_t kNoColour = 128;
  unsigned long size = tjBufSize(image.width, image.height, layout);
  thread_local std::vector<std::uint8_t> room, colour;  // fresh pages cost as much as the encoding
  room.resize(size);
  const int colour_width = tjPlaneWidth(1, image.width, layout);
  colour.resize(static_cast<std::size_t>(colour_width) *
                    static_cast<std::size_t>(tjPlaneHeight(1, image.height, layout)),
                kNoColour);
  const int luma_width = tjPlaneWidth(0, image.width, layout);
  const std::uint8_t* planes[3] = {
      lumaOf(image, luma_width, tjPlaneHeight(0, image.height, layout)), colour.data(),
      colour.data()};
  const int strides[3] = {luma_width, colour_width, colour_width};
  std::uint8_t* to = room.data();
  if (tjCompressFromYUVPlanes(compressor.get(), planes, image.width, strides, image.height, layout,
                              &to, &size, quality, TJFLAG_NOREALLOC | TJFLAG_ACCURATEDCT) != 0) {
    const std::string reason = tjGetErrorStr2(compressor.get());
    // The library has one code for all errors; what is short of memory must end as such.
    if (reason.find("memory") != std::string::npos) throw std::bad_alloc();
    throw JobError(fmt::format("a frame cannot be encoded as JPEG: {}", reason));
  }
  return asBytes(room.data(), size);
}

std::vector<std::byte> encodeFfv1(const GreyImage& image) {
  // A new encoder costs four frames' time (it clears 150 bytes of scratch memory per pixel), so
  // each thread keeps its last one. Key frames share nothing: the bytes are those of a new encoder.
  thread_local CodecContext codec;
  if (!codec || codec->width != image.width || codec->height != image.height)
    codec = openFfv1(image.width, image.height);
  const FrameOwner frame(av_frame_alloc());
  const PacketOwner packet(av_packet_alloc());
  if (!frame || !packet) throw std::bad_alloc();
  frame->format = AV_PIX_FMT_GRAY8;
  frame->width = image.width;
  frame->height = image.height;
  // Without a reference-counted buffer the encoder copies the pixels.
  frame->data[0] = const_cast<std::uint8_t*>(image.pixels.data());
  frame->linesize[0] = image.width;
  frame->pts = 0;
  int error = avcodec_send_frame(codec.get(), frame.get());
  if (error >= 0) error = avcodec_receive_packet(codec.get(), packet.get());
  if (error < 0) codec.reset();  // what it holds of the frame must not come out later
  if (error == AVERROR(ENOMEM)) throw std::bad_alloc();
  if (error < 0) throw JobError("a frame cannot be encoded as FFV1");
  return asBytes(packet->data, static_cast<std::size_t>(packet->size));
}

}  // namespace

void silenceLibav() {
  [[maybe_unused]] static const bool done = [] {
    av_log_set_level(AV_LOG_QUIET);
    return true;
  }();
}

void CodecContextFree::operator()(AVCodecContext* context) const {
  avcodec_free_context(&context);
}

CodecContext openFfv1(int width, int height) {
  silenceLibav();
  const AVCodec* codec = avcodec_find_encoder(AV_CODEC_ID_FFV1);
  if (codec == nullptr)
    throw JobError("cine codec ffv1: the installed libavcodec has no FFV1 encoder, use mjpg");
  CodecContext context(avcodec_alloc_context3(codec));
  if (!context) throw std::bad_alloc();
  context->width = width;
  context->height = height;
  context->pix_fmt = AV_PIX_FMT_GRAY8;
  context->time_base = {1, 1};  // of no effect on the bytes
  context->gop_size = 1;        // key frames only
  context->level = 3;           // the version that RFC 9043 standardises, with a checksum per slice
  context->thread_count = 1;    // frames are encoded in parallel already
  context->flags |= AV_CODEC_FLAG_BITEXACT;
  // The range coder takes a tenth longer than Golomb codes and a third off a smooth picture.
  av_opt_set(context->priv_data, "coder", "range_def", 0);
  const int error = avcodec_open2(context.get(), codec, nullptr);
  if (error == AVERROR(ENOMEM)) throw std::bad_alloc();
  if (error < 0)
    throw JobError(fmt::format("cine codec ffv1: {} x {} pixels are not accepted", width, height));
  return context;
}

std::vector<std::byte> encodeCineFrame(const GreyImage& image, CineCodec codec, int jpeg_quality) {
  checkSize(image);
  if (codec == CineCodec::ffv1) return encodeFfv1(image);
  return encodeJpeg(image, jpeg_quality, TJSAMP_420);
}

// The chroma of YBR_FULL_422 is subsampled along rows alone.
std::vector<std::byte> encodeDicomFrame(const GreyImage& image, const OutputSettings& output) {
  checkSize(image);
  if (!isPlainDicom(output)) return encodeJpeg(image, output.jpeg_quality, TJSAMP_422);
  std::vector<std::byte> rgb;
  rgb.reserve(3 * image.pixels.size());
  for (const std::uint8_t grey : image.pixels) rgb.insert(rgb.end(), 3, std::byte{grey});
  return rgb;
}

namespace {

std::vector<std::byte> pngOf(const GreyImage& image, std::span<const PaletteColour> palette) {
  checkSize(image);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = palette.empty() ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB_COLORMAP;
  png.colormap_entries = static_cast<png_uint_32>(palette.size());
  png.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<std::byte> bytes(size);
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0,
                                palette.empty() ? nullptr : palette.data()) == 0) {
    if (std::string_view(png.message).find("memory") != std::string_view::npos)
      throw std::bad_alloc();
    throw JobError(fmt::format("a frame cannot be encoded as PNG: {}", png.message));
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace

std::vector<std::byte> encodePng(const GreyImage& image) {
  return pngOf(image, {});
}

std::vector<std::byte> encodePng(const GreyImage& image, std::span<const PaletteColour> palette) {
  return pngOf(image, palette);
}

}  // namespace echocine
