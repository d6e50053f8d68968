#pragma once
// How many pictures a player finds in a cine.

extern "C" {
#include <libavformat/avformat.h>
}

#include <filesystem>

namespace echocine::support {

// Frames of the first stream; -1 when the file is no video.
inline int cineFrames(const std::filesystem::path& file) {
  AVFormatContext* context = nullptr;
  if (avformat_open_input(&context, file.c_str(), nullptr, nullptr) != 0) return -1;
  int frames = avformat_find_stream_info(context, nullptr) < 0 ? -1 : 0;
  AVPacket* packet = av_packet_alloc();
  while (frames >= 0 && av_read_frame(context, packet) == 0) {
    ++frames;
    av_packet_unref(packet);
  }
  av_packet_free(&packet);
  avformat_close_input(&context);
  return frames;
}

}  // namespace echocine::support
