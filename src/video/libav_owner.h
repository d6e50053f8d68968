#pragma once
// Owners of libavcodec's frames and packets.

#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace echocine {

struct FrameFree {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
using FrameOwner = std::unique_ptr<AVFrame, FrameFree>;

struct PacketFree {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
using PacketOwner = std::unique_ptr<AVPacket, PacketFree>;

}  // namespace echocine
