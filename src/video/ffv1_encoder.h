#pragma once
// The lossless codec of a cine, with the same settings for encoding a frame and for describing the
// stream.

#include <memory>

struct AVCodecContext;

namespace echocine {

// Silences the libraries' own messages: errors are returned as values and reported once.
void silenceLibav();

struct CodecContextFree {
  void operator()(AVCodecContext* context) const;
};
using CodecContext = std::unique_ptr<AVCodecContext, CodecContextFree>;

// An open FFV1 encoder of 8-bit grey key frames. Version 3 of the format stores its parameters in a
// stream header that depends only on the size, so every encoder of one size has the same header.
// Throws JobError if libavcodec lacks the codec or rejects the size.
CodecContext openFfv1(int width, int height);

}  // namespace echocine
