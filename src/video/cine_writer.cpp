#include "video/cine_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "core/file.h"
#include "video/ffv1_encoder.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace echocine {

Rational rationalFrameRate(double frame_rate_hz) {
  // Rates of the television family are written rounded (29.97 for 30000/1001), 1e-6 off at most.
  constexpr double kRounding = 2e-6;
  constexpr int kLargestDenominator = 1001;
  for (const int nominal : {15, 24, 30, 48, 60, 120, 240}) {
    const double exact = nominal * 1000.0 / 1001.0;
    if (std::abs(frame_rate_hz - exact) <= kRounding * exact) return {nominal * 1000, 1001};
  }
  // The smallest denominator that is near enough: files keep it exactly, and players understand it.
  Rational best;
  double least_error = std::numeric_limits<double>::infinity();
  for (int denominator = 1; denominator <= kLargestDenominator; ++denominator) {
    const double numerator = std::max(1.0, std::round(frame_rate_hz * denominator));
    const double error = std::abs(numerator / denominator - frame_rate_hz);
    if (error < least_error) {
      least_error = error;
      best = {static_cast<int>(numerator), denominator};
    }
    if (error <= 1e-12 * frame_rate_hz) break;  // a rate that was computed may be some ulps off
  }
  return best;
}

// libavformat's muxer over a file descriptor of our own, so that the system's reason for a failed
// write is known, and the file is complete before it has its final name.
struct CineWriter::Muxer {
  std::filesystem::path path;
  std::string part;
  OutputSettings settings;
  Rational rate;
  int descriptor = -1;
  int failure = 0;  // errno of the first failed write
  AVFormatContext* format = nullptr;
  AVPacket* packet = nullptr;
  std::int64_t frames = 0;
  bool sound = true;  // no frame was written in part

  ~Muxer();
  void open();
  void openContext();
  void describeStream();
  void close(bool may_shorten);
  bool isShorterThanWhatStands() const;
  [[noreturn]] void fail(int system_error) const;
  [[noreturn]] void failOf(int libav_error) const;

  static int writeBytes(void* self, std::uint8_t* data, int size);
  static std::int64_t seekTo(void* self, std::int64_t offset, int whence);
};

// A file that was not finished has no name yet: it goes with the muxer.
CineWriter::Muxer::~Muxer() {
  av_packet_free(&packet);
  if (format != nullptr) {
    if (format->pb != nullptr) av_freep(&format->pb->buffer);
    avio_context_free(&format->pb);
    avformat_free_context(format);
  }
  if (descriptor >= 0) {
    ::close(descriptor);
    ::unlink(part.c_str());
  }
}

void CineWriter::Muxer::fail(int system_error) const {
  throw JobError(
      fmt::format("{}: cannot be written: {}", path.string(), std::strerror(system_error)));
}

void CineWriter::Muxer::failOf(int libav_error) const {
  if (failure != 0) fail(failure);
  if (libav_error == AVERROR(ENOMEM)) throw std::bad_alloc();
  char reason[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(libav_error, reason, sizeof(reason));
  throw JobError(fmt::format("{}: cannot be written: {}", path.string(), reason));
}

// May write in part or be interrupted; goes on until all is out. The first error's errno is kept
// for the message.
int CineWriter::Muxer::writeBytes(void* self, std::uint8_t* data, int size) {
  auto& muxer = *static_cast<Muxer*>(self);
  for (int done = 0; done < size;) {
    const ssize_t written =
        ::write(muxer.descriptor, data + done, static_cast<std::size_t>(size - done));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      if (muxer.failure == 0) muxer.failure = errno;
      return AVERROR(muxer.failure);
    }
    done += static_cast<int>(written);
  }
  return size;
}

// The muxer goes back to fill in the number of frames and the index.
std::int64_t CineWriter::Muxer::seekTo(void* self, std::int64_t offset, int whence) {
  auto& muxer = *static_cast<Muxer*>(self);
  if ((whence & AVSEEK_SIZE) != 0) {
    struct stat status {};
    return ::fstat(muxer.descriptor, &status) == 0 ? status.st_size : AVERROR(errno);
  }
  const off_t position = ::lseek(muxer.descriptor, offset, whence & ~AVSEEK_FORCE);
  return position >= 0 ? position : AVERROR(errno);
}

void CineWriter::Muxer::open() {
  // Read and write: the muxer reads back what it fills in at the end.
  PartFile made = makePart(path);
  descriptor = made.descriptor;
  part = std::move(made.name);
  if (descriptor < 0) fail(errno);
  openContext();
  describeStream();
  const int error = avformat_write_header(format, nullptr);
  if (error < 0) failOf(error);
}

void CineWriter::Muxer::openContext() {
  constexpr int kBufferBytes = 1 << 18;
  silenceLibav();
  const int error = avformat_alloc_output_context2(&format, nullptr, "avi", nullptr);
  if (error == AVERROR(ENOMEM)) throw std::bad_alloc();
  if (error < 0)
    throw JobError(fmt::format("{}: the installed libavformat cannot write AVI", path.string()));
  packet = av_packet_alloc();
  auto* buffer = static_cast<unsigned char*>(av_malloc(kBufferBytes));
  if (packet == nullptr || buffer == nullptr) throw std::bad_alloc();
  format->pb = avio_alloc_context(buffer, kBufferBytes, 1, this, nullptr, writeBytes, seekTo);
  if (format->pb == nullptr) throw std::bad_alloc();
  // Bit-exact: no name of the library in the file, so equal loops are equal bytes.
  format->flags |= AVFMT_FLAG_CUSTOM_IO | AVFMT_FLAG_BITEXACT;
}

// A frame lasts one unit of the time base.
void CineWriter::Muxer::describeStream() {
  AVStream* stream = avformat_new_stream(format, nullptr);
  if (stream == nullptr) throw std::bad_alloc();
  stream->time_base = {rate.denominator, rate.numerator};
  stream->avg_frame_rate = {rate.numerator, rate.denominator};
  AVCodecParameters& codec = *stream->codecpar;
  if (settings.codec == CineCodec::ffv1) {
    const CodecContext encoder = openFfv1(settings.width, settings.height);
    if (avcodec_parameters_from_context(&codec, encoder.get()) < 0) throw std::bad_alloc();
    return;
  }
  codec.codec_type = AVMEDIA_TYPE_VIDEO;
  codec.codec_id = AV_CODEC_ID_MJPEG;
  codec.format = AV_PIX_FMT_YUVJ420P;
  codec.color_range = AVCOL_RANGE_JPEG;  // 0 to 255
  codec.width = settings.width;
  codec.height = settings.height;
}

// In bytes: frames of one scene take nearly the same room, and nothing has to be read.
bool CineWriter::Muxer::isShorterThanWhatStands() const {
  struct stat mine {
  }, there{};
  return ::fstat(descriptor, &mine) == 0 && ::stat(path.c_str(), &there) == 0 &&
         mine.st_size < there.st_size;
}

// The trailer has the index, without which players cannot seek.
void CineWriter::Muxer::close(bool may_shorten) {
  const int error = av_write_trailer(format);
  if (error < 0 || failure != 0) failOf(error);
  if (!may_shorten && isShorterThanWhatStands()) return;
  if (!syncFile(descriptor)) fail(errno);
  const int closing = std::exchange(descriptor, -1);
  if (::close(closing) != 0 || ::rename(part.c_str(), path.c_str()) != 0) {
    const int reason = errno;
    ::unlink(part.c_str());
    fail(reason);
  }
  syncFolderOf(path);
}

CineWriter::CineWriter(std::filesystem::path path, const OutputSettings& settings,
                       double frame_rate_hz)
    : muxer_(std::make_unique<Muxer>()) {
  muxer_->path = std::move(path);
  muxer_->settings = settings;
  muxer_->rate = rationalFrameRate(frame_rate_hz);
}

CineWriter::~CineWriter() = default;

void CineWriter::add(std::span<const std::byte> encoded_frame) {
  Muxer& muxer = *muxer_;
  // Until this frame is in whole: an exception on the way leaves the file unfit to be finished.
  muxer.sound = false;
  if (muxer.frames == 0) muxer.open();
  // The muxer only reads; the packet lends it the bytes for the time of the call.
  AVPacket& packet = *muxer.packet;
  packet.data = reinterpret_cast<std::uint8_t*>(const_cast<std::byte*>(encoded_frame.data()));
  packet.size = static_cast<int>(encoded_frame.size());
  packet.pts = packet.dts = muxer.frames;
  packet.duration = 1;
  packet.flags = AV_PKT_FLAG_KEY;
  packet.stream_index = 0;
  const int error = av_write_frame(muxer.format, &packet);
  if (error < 0 || muxer.failure != 0) muxer.failOf(error);
  ++muxer.frames;
  muxer.sound = true;
}

void CineWriter::finish() {
  if (muxer_->frames > 0) muxer_->close(true);
}

// A frame written in part would end the cine in garbage: then it is not kept.
void CineWriter::finishEarly() {
  if (muxer_->frames > 0 && muxer_->sound) muxer_->close(false);
}

}  // namespace echocine
