#include "video/animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <new>
#include <span>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "video/ffv1_encoder.h"
#include "video/libav_owner.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

namespace echocine {

// Frees the bytes that the muxer has written so far, too.
struct MemoryMuxerFree {
  void operator()(AVFormatContext* format) const {
    if (format->pb != nullptr) {
      std::uint8_t* bytes = nullptr;
      avio_close_dyn_buf(format->pb, &bytes);
      av_free(bytes);
    }
    avformat_free_context(format);
  }
};

// Rec. 601 with luma 16 to 235 and chroma 16 to 240, the range that all players expect of MP4.
struct YuvColour {
  double y = 0, u = 0, v = 0;
};

namespace {

// An encoder's name in libavcodec, and the format's name for users.
struct Encoder {
  const char *name, *title;
};
constexpr Encoder kMp4[] = {{"libx264", "H.264"}, {"mpeg4", "MPEG-4 part 2"}};
constexpr Encoder kGif[] = {{"gif", "GIF"}};
constexpr Encoder kWebp[] = {{"libwebp_anim", "WebP"}};

std::span<const Encoder> encodersOf(AnimationFormat format) {
  switch (format) {
    case AnimationFormat::gif:
      return kGif;
    case AnimationFormat::webp:
      return kWebp;
    case AnimationFormat::mp4:
      break;
  }
  return kMp4;
}

const char* muxerOf(AnimationFormat format) {
  constexpr const char* kNames[] = {"mp4", "gif", "webp"};
  return kNames[static_cast<std::size_t>(format)];
}

void checkLibav(int error, const char* title) {
  if (error >= 0) return;
  if (error == AVERROR(ENOMEM)) throw std::bad_alloc();
  char reason[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(error, reason, sizeof(reason));
  throw JobError(fmt::format("the loop cannot be encoded as {}: {}", title, reason));
}

YuvColour yuvOf(PaletteColour c) {
  const double luma = 0.299 * c.red + 0.587 * c.green + 0.114 * c.blue;
  return {16 + luma * 219 / 255, 128 + (c.blue - luma) / 1.772 * 224 / 255,
          128 + (c.red - luma) / 1.402 * 224 / 255};
}

std::uint8_t byteOf(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

std::uint8_t* rowOf(AVFrame& frame, int plane, int y) {
  return frame.data[plane] + std::ptrdiff_t{y} * frame.linesize[plane];
}

// Chroma of 2 x 2 pixels is their mean.
void fillYuv(AVFrame& frame, const GreyImage& image, const std::array<YuvColour, 256>& colours) {
  const auto at = [&](int x, int y) -> const YuvColour& {
    return colours[image
                       .pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                               static_cast<std::size_t>(x)]];
  };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) rowOf(frame, 0, y)[x] = byteOf(at(x, y).y);
  for (int y = 0; y + 1 < image.height; y += 2)
    for (int x = 0; x + 1 < image.width; x += 2) {
      const YuvColour &a = at(x, y), &b = at(x + 1, y), &c = at(x, y + 1), &d = at(x + 1, y + 1);
      rowOf(frame, 1, y / 2)[x / 2] = byteOf((a.u + b.u + c.u + d.u) / 4);
      rowOf(frame, 2, y / 2)[x / 2] = byteOf((a.v + b.v + c.v + d.v) / 4);
    }
}

std::uint32_t argbOf(PaletteColour c) {
  return 0xff000000U | static_cast<std::uint32_t>(c.red) << 16 |
         static_cast<std::uint32_t>(c.green) << 8 | c.blue;
}

}  // namespace

std::optional<AnimationFormat> animationFormatOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".mp4") return AnimationFormat::mp4;
  if (extension == ".gif") return AnimationFormat::gif;
  if (extension == ".webp") return AnimationFormat::webp;
  return std::nullopt;
}

struct AnimationEncoder::Impl {
  AnimationSettings settings;
  std::array<YuvColour, 256> yuv{};
  const char* title = "";
  CodecContext codec;
  std::unique_ptr<AVFormatContext, MemoryMuxerFree> format;
  FrameOwner frame;
  PacketOwner packet;
  std::int64_t frames = 0;

  void openCodec();
  void setQuality();
  void openFormat();
  void fill(const GreyImage& image);
  void encode(AVFrame* next);
};

void AnimationEncoder::Impl::openCodec() {
  silenceLibav();
  const AVCodec* found = nullptr;
  for (const Encoder& encoder : encodersOf(settings.format)) {
    title = encoder.title;
    found = avcodec_find_encoder_by_name(encoder.name);
    if (found != nullptr) break;
  }
  if (found == nullptr)
    throw JobError(fmt::format("the installed libavcodec has no {} encoder", title));
  codec.reset(avcodec_alloc_context3(found));
  if (!codec) throw std::bad_alloc();
  const Rational rate = rationalFrameRate(settings.frame_rate_hz);
  codec->width = settings.width;
  codec->height = settings.height;
  codec->time_base = {rate.denominator, rate.numerator};
  codec->thread_count = 1;  // with threads, libx264 may choose other bytes
  codec->flags |= AV_CODEC_FLAG_BITEXACT;
  setQuality();
  checkLibav(avcodec_open2(codec.get(), found, nullptr), title);
}

// Qualities are our choice: no visible loss of speckle.
void AnimationEncoder::Impl::setQuality() {
  switch (settings.format) {
    case AnimationFormat::gif:
      codec->pix_fmt = AV_PIX_FMT_PAL8;
      codec->time_base = {1, 100};
      return;
    case AnimationFormat::webp:
      codec->pix_fmt = AV_PIX_FMT_RGB32;
      av_opt_set(codec->priv_data, "quality", "85", 0);
      return;
    case AnimationFormat::mp4:
      break;
  }
  codec->pix_fmt = AV_PIX_FMT_YUV420P;
  codec->color_range = AVCOL_RANGE_MPEG;
  codec->colorspace = AVCOL_SPC_SMPTE170M;
  codec->framerate = {codec->time_base.den, codec->time_base.num};
  codec->gop_size = 12;
  codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  if (codec->codec_id == AV_CODEC_ID_H264) {
    av_opt_set(codec->priv_data, "crf", "18", 0);
    av_opt_set(codec->priv_data, "preset", "medium", 0);
    // Its lookahead reads memory that it has not set: coloured loops got other bytes.
    av_opt_set(codec->priv_data, "mbtree", "0", 0);
  } else {
    codec->flags |= AV_CODEC_FLAG_QSCALE;
    codec->global_quality = 3 * FF_QP2LAMBDA;
  }
}

void AnimationEncoder::Impl::openFormat() {
  AVFormatContext* made = nullptr;
  checkLibav(avformat_alloc_output_context2(&made, nullptr, muxerOf(settings.format), nullptr),
             title);
  format.reset(made);
  format->flags |= AVFMT_FLAG_BITEXACT;
  AVStream* stream = avformat_new_stream(made, nullptr);
  if (stream == nullptr) throw std::bad_alloc();
  stream->time_base = codec->time_base;
  stream->avg_frame_rate = codec->framerate;
  checkLibav(avcodec_parameters_from_context(stream->codecpar, codec.get()), title);
  checkLibav(avio_open_dyn_buf(&made->pb), title);
  AVDictionary* options = nullptr;
  if (settings.format != AnimationFormat::mp4) av_dict_set(&options, "loop", "0", 0);  // no end
  const int error = avformat_write_header(made, &options);
  av_dict_free(&options);
  checkLibav(error, title);
}

void AnimationEncoder::Impl::fill(const GreyImage& image) {
  checkLibav(av_frame_make_writable(frame.get()), title);
  if (settings.format == AnimationFormat::mp4) return fillYuv(*frame, image, yuv);
  const auto width = static_cast<std::size_t>(image.width);
  for (int y = 0; y < image.height; ++y) {
    const std::uint8_t* from = image.pixels.data() + static_cast<std::size_t>(y) * width;
    std::uint8_t* to = rowOf(*frame, 0, y);
    if (settings.format == AnimationFormat::gif)
      std::copy_n(from, width, to);
    else
      for (std::size_t x = 0; x < width; ++x)
        reinterpret_cast<std::uint32_t*>(to)[x] = argbOf(settings.colours[from[x]]);
  }
  if (settings.format != AnimationFormat::gif) return;
  for (std::size_t i = 0; i < settings.colours.size(); ++i)
    reinterpret_cast<std::uint32_t*>(frame->data[1])[i] = argbOf(settings.colours[i]);
}

// nullptr: the last frames that the encoder holds.
void AnimationEncoder::Impl::encode(AVFrame* next) {
  checkLibav(avcodec_send_frame(codec.get(), next), title);
  for (;;) {
    const int error = avcodec_receive_packet(codec.get(), packet.get());
    if (error == AVERROR(EAGAIN) || error == AVERROR_EOF) return;
    checkLibav(error, title);
    if (settings.format == AnimationFormat::mp4 && packet->duration == 0) packet->duration = 1;
    av_packet_rescale_ts(packet.get(), codec->time_base, format->streams[0]->time_base);
    packet->stream_index = 0;
    checkLibav(av_write_frame(format.get(), packet.get()), title);
    av_packet_unref(packet.get());
  }
}

AnimationEncoder::AnimationEncoder(const AnimationSettings& settings)
    : impl_(std::make_unique<Impl>()) {
  CHECK_LT(0, settings.width);
  CHECK_LT(0, settings.height);
  impl_->settings = settings;
  std::transform(settings.colours.begin(), settings.colours.end(), impl_->yuv.begin(), yuvOf);
  impl_->openCodec();
  impl_->openFormat();
  impl_->frame.reset(av_frame_alloc());
  impl_->packet.reset(av_packet_alloc());
  if (!impl_->frame || !impl_->packet) throw std::bad_alloc();
  AVFrame& frame = *impl_->frame;
  frame.format = impl_->codec->pix_fmt;
  frame.width = settings.width;
  frame.height = settings.height;
  checkLibav(av_frame_get_buffer(&frame, 0), impl_->title);
}

AnimationEncoder::~AnimationEncoder() = default;

void AnimationEncoder::add(const GreyImage& image) {
  Impl& impl = *impl_;
  CHECK_EQ(image.width, impl.settings.width);
  CHECK_EQ(image.height, impl.settings.height);
  impl.fill(image);
  const double time = static_cast<double>(impl.frames++) / impl.settings.frame_rate_hz;
  impl.frame->pts = std::llround(time / av_q2d(impl.codec->time_base));
  impl.encode(impl.frame.get());
}

std::vector<std::byte> AnimationEncoder::finish() {
  Impl& impl = *impl_;
  CHECK_LT(0, impl.frames);
  impl.encode(nullptr);
  checkLibav(av_write_trailer(impl.format.get()), impl.title);
  std::uint8_t* bytes = nullptr;
  const int size = avio_close_dyn_buf(std::exchange(impl.format->pb, nullptr), &bytes);
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  const std::unique_ptr<std::uint8_t, void (*)(void*)> owner(bytes, av_free);
  if (size <= 0) throw std::bad_alloc();
  return {first, first + size};
}

std::string_view AnimationEncoder::codec() const {
  return impl_->title;
}

}  // namespace echocine
