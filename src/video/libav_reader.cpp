#include "video/libav_reader.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libswscale/swscale.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string_view>

#include "core/error.h"
#include "core/stop.h"

namespace echocine {

namespace {

// Containers that hold one loop and nothing that points elsewhere (no play lists).
constexpr const char* kFormats =
    "avi,mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,gif,apng,mpeg,mpegts,asf,ogg,flv,nut,wmv,"
    "png_pipe,jpeg_pipe,bmp_pipe,tiff_pipe,webp_pipe,image2pipe";

// A file in memory: nothing that a container points to is opened.
struct Bytes {
  std::span<const std::byte> all;
  std::int64_t at = 0;
};

// As libav wants it: at the end an error, not 0.
int readBytes(void* opaque, std::uint8_t* out, int size) {
  auto* bytes = static_cast<Bytes*>(opaque);
  const std::int64_t left = static_cast<std::int64_t>(bytes->all.size()) - bytes->at;
  if (left <= 0) return AVERROR_EOF;
  const auto n = static_cast<std::size_t>(std::min<std::int64_t>(left, size));
  std::memcpy(out, bytes->all.data() + bytes->at, n);
  bytes->at += static_cast<std::int64_t>(n);
  return static_cast<int>(n);
}

std::int64_t seekBytes(void* opaque, std::int64_t offset, int whence) {
  auto* bytes = static_cast<Bytes*>(opaque);
  const auto size = static_cast<std::int64_t>(bytes->all.size());
  if (whence & AVSEEK_SIZE) return size;
  const std::int64_t from = whence == SEEK_CUR ? bytes->at : whence == SEEK_END ? size : 0;
  if (offset < -from || offset > size - from) return AVERROR(EINVAL);
  return bytes->at = from + offset;
}

std::string reasonOf(int error) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(error, text, sizeof text);
  return text;
}

// Besides one frame, packets of a complete Matroska file may end this long before the stated
// duration, because of the last frame of sound. Our choice.
constexpr double kLoose_s = 0.1;

// Owns what the C libraries hand out. A name goes into every message.
struct Decoder {
  Bytes bytes;
  std::string name;
  AVIOContext* io = nullptr;
  AVFormatContext* format = nullptr;
  AVCodecContext* codec = nullptr;
  AVFrame* frame = nullptr;
  AVPacket* packet = nullptr;
  SwsContext* scaler = nullptr;
  int stream = -1;
  bool unreadable = false;  // the file goes on, but cannot be read
  double end_s = 0;         // of the packets read, of all streams
  std::vector<std::uint8_t> rgb;

  ~Decoder() {
    sws_freeContext(scaler);
    av_packet_free(&packet);
    av_frame_free(&frame);
    avcodec_free_context(&codec);
    avformat_close_input(&format);
    if (io != nullptr) av_freep(&io->buffer);
    avio_context_free(&io);
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw SceneError(fmt::format("{}: {}", name, what));
  }
  // Duration that a Matroska file states; 0: none. Others have a number of frames, or guess it.
  double headerSeconds() const {
    const bool states = std::string_view(format->iformat->name).starts_with("matroska");
    return states && format->duration > 0 &&
                   format->duration_estimation_method != AVFMT_DURATION_FROM_BITRATE
               ? static_cast<double>(format->duration) / AV_TIME_BASE
               : 0;
  }
  void open();
  void openCodec();
  void readAll(VideoBuilder& builder);
  void takeFrames(VideoBuilder& builder);
  void addFrame(VideoBuilder& builder);
};

void Decoder::open() {
  av_log_set_level(AV_LOG_QUIET);  // what goes wrong comes back as a value and is reported once
  constexpr int kBuffer = 1 << 16;
  auto* buffer = static_cast<unsigned char*>(av_malloc(kBuffer));
  io = avio_alloc_context(buffer, kBuffer, 0, &bytes, readBytes, nullptr, seekBytes);
  format = avformat_alloc_context();
  if (buffer == nullptr || io == nullptr || format == nullptr) throw std::bad_alloc();
  format->pb = io;
  AVDictionary* options = nullptr;
  av_dict_set(&options, "format_whitelist", kFormats, 0);
  av_dict_set(&options, "protocol_whitelist", "", 0);
  const int opened = avformat_open_input(&format, nullptr, nullptr, &options);
  av_dict_free(&options);
  if (opened < 0)
    refuse(
        "is not a readable video or picture; give an AVI, MP4, GIF, DICOM, or a folder of PNG "
        "or JPEG frames");
  stream = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (stream >= 0) {
    const AVCodecParameters& p = *format->streams[stream]->codecpar;
    if (p.width > 0 && p.height > 0) checkLoopSize(name, p.width, p.height, 1);
  }
  // Frame sizes are probed within this limit too.
  const std::string limit = std::to_string(kMaxFramePixels);
  std::vector<AVDictionary*> probing(format->nb_streams, nullptr);
  for (AVDictionary*& each : probing) av_dict_set(&each, "max_pixels", limit.c_str(), 0);
  const int probed = avformat_find_stream_info(format, probing.data());
  for (AVDictionary*& each : probing) av_dict_free(&each);
  stream = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (stream < 0 || probed < 0)
    refuse("holds no video stream; give an AVI, MP4, GIF or DICOM loop");
}

void Decoder::openCodec() {
  const AVCodecParameters& p = *format->streams[stream]->codecpar;
  const AVCodec* decoder = avcodec_find_decoder(p.codec_id);
  if (decoder == nullptr)
    refuse(
        fmt::format("codec {} cannot be decoded here; convert the loop to AVI (MJPEG, FFV1) or "
                    "MP4 (H.264)",
                    p.codec_id == AV_CODEC_ID_NONE ? "unknown" : avcodec_get_name(p.codec_id)));
  codec = avcodec_alloc_context3(decoder);
  frame = av_frame_alloc();
  packet = av_packet_alloc();
  if (codec == nullptr || frame == nullptr || packet == nullptr) throw std::bad_alloc();
  if (avcodec_parameters_to_context(codec, &p) < 0) refuse("its stream has no usable header");
  codec->max_pixels = kMaxFramePixels;
  // Frames in order and errors where they occur: threads would deliver both late.
  codec->thread_count = 1;
  if (avcodec_open2(codec, decoder, nullptr) < 0)
    refuse(
        fmt::format("codec {} refuses the stream; convert the loop to AVI (MJPEG, FFV1) or MP4 "
                    "(H.264)",
                    avcodec_get_name(p.codec_id)));
}

// Colours as red, green, blue in square pixels.
void Decoder::addFrame(VideoBuilder& builder) {
  const AVRational shape = av_guess_sample_aspect_ratio(format, format->streams[stream], frame);
  double aspect = shape.num > 0 && shape.den > 0 ? av_q2d(shape) : 1;
  // A header that says more is wrong.
  if (!(aspect > 0.2 && aspect < 5)) aspect = 1;
  const auto width = static_cast<int>(std::lround(frame->width * aspect));
  checkLoopSize(name, width, frame->height, builder.video().frameCount() + 1);
  if (width != frame->width && builder.video().frames.empty())
    builder.video().notes.push_back(
        fmt::format("pixels are {} times as wide as high by its header; stretched to {} x {}",
                    aspect, width, frame->height));
  const auto source = static_cast<AVPixelFormat>(frame->format);
  scaler = sws_getCachedContext(
      scaler, frame->width, frame->height, source, width, frame->height, AV_PIX_FMT_RGB24,
      SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT, nullptr, nullptr, nullptr);
  if (scaler == nullptr) refuse("its pixel format cannot be turned into colours");
  // Full-range sources (JPEG) keep their range; without this black would come out as 16.
  int *inverse = nullptr, *table = nullptr, from_full = 0, to_full = 0, b = 0, c = 0, s = 0;
  if (frame->color_range == AVCOL_RANGE_JPEG &&
      sws_getColorspaceDetails(scaler, &inverse, &from_full, &table, &to_full, &b, &c, &s) >= 0)
    sws_setColorspaceDetails(scaler, inverse, 1, table, to_full, b, c, s);
  const int stride = 3 * width;
  // The scaler may write some bytes past the last row.
  rgb.resize(static_cast<std::size_t>(stride) * static_cast<std::size_t>(frame->height) + 64);
  std::uint8_t* const planes[4] = {rgb.data()};
  const int strides[4] = {stride};
  if (sws_scale(scaler, frame->data, frame->linesize, 0, frame->height, planes, strides) <= 0)
    refuse("a frame cannot be turned into colours");
  builder.add(rgb.data(), width, frame->height, stride);
}

void Decoder::takeFrames(VideoBuilder& builder) {
  for (;;) {
    checkpoint();
    const int got = avcodec_receive_frame(codec, frame);
    if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return;
    if (got < 0 || frame->flags & AV_FRAME_FLAG_CORRUPT || frame->decode_error_flags != 0)
      refuse(fmt::format("frame {} is damaged or cut off{}; give the whole file again",
                         builder.video().frameCount(), got < 0 ? " (" + reasonOf(got) + ")" : ""));
    addFrame(builder);
    av_frame_unref(frame);
  }
}

void Decoder::readAll(VideoBuilder& builder) {
  for (;;) {
    const int read = av_read_frame(format, packet);
    if (read < 0) {
      unreadable = read != AVERROR_EOF;
      break;
    }
    builder.checkTime();
    if (packet->pts != AV_NOPTS_VALUE)
      end_s = std::max(end_s, static_cast<double>(packet->pts + packet->duration) *
                                  av_q2d(format->streams[packet->stream_index]->time_base));
    if (packet->stream_index == stream) {
      const int sent = avcodec_send_packet(codec, packet);
      if (sent < 0 && sent != AVERROR(EAGAIN) && sent != AVERROR_EOF)
        refuse(fmt::format("frame {} is damaged or cut off ({}); give the whole file again",
                           builder.video().frameCount(), reasonOf(sent)));
      takeFrames(builder);
    }
    av_packet_unref(packet);
  }
  // The end: the decoder gives out what it held back for reordering.
  avcodec_send_packet(codec, nullptr);
  takeFrames(builder);
}

}  // namespace

void readByLibav(std::span<const std::byte> bytes, VideoBuilder& builder) {
  Decoder decoder;
  builder.expectBytes(bytes.size());
  decoder.bytes.all = bytes;
  decoder.name = builder.video().name;
  decoder.open();
  decoder.openCodec();
  const AVStream& stream = *decoder.format->streams[decoder.stream];
  builder.video().format = decoder.format->iformat->name;
  // The mean rate where the container has one; the other is a guess from its clock.
  const AVRational rate =
      stream.avg_frame_rate.num > 0 ? stream.avg_frame_rate : stream.r_frame_rate;
  if (rate.num > 0 && rate.den > 0) builder.video().rate = {av_q2d(rate), "container", false};
  decoder.readAll(builder);
  // GIF ends with a trailer of its own; others say in their headers how many frames there are.
  const bool gif = std::string_view(decoder.format->iformat->name) == "gif";
  const auto frames = static_cast<std::int64_t>(builder.video().frames.size());
  if (gif && !bytes.empty() && bytes.back() != std::byte{0x3b})
    builder.video().notes.push_back(
        fmt::format("it is cut off after {} frames: its end is missing", frames));
  else if (stream.nb_frames > frames)
    builder.video().notes.push_back(fmt::format(
        "it is cut off: {} of the {} frames in its header are present", frames, stream.nb_frames));
  else if (const double whole_s = decoder.headerSeconds();
           decoder.end_s < whole_s - kLoose_s - (rate.num > 0 ? av_q2d(av_inv_q(rate)) : 0))
    builder.video().notes.push_back(
        fmt::format("it is cut off: {:.2f} s of the {:.2f} s in its header are present",
                    decoder.end_s, whole_s));
  else if (decoder.unreadable)
    builder.video().notes.push_back(
        fmt::format("it cannot be read beyond frame {}: it may be cut off", frames));
}

}  // namespace echocine
