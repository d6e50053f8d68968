#pragma once
// The lossless codec of a cine, opened the same way for encoding a frame and for describing the
// stream.

#include <memory>

struct AVCodecContext;

namespace echocine {

// Keeps the libraries' own lines off the terminal: what goes wrong comes back as a value and is
// reported once.
void silenceLibav();

struct CodecContextFree {
  void operator()(AVCodecContext* context) const;
};
using CodecContext = std::unique_ptr<AVCodecContext, CodecContextFree>;

// An open FFV1 encoder of 8-bit grey key frames. Version 3 of the format keeps its parameters in a
// stream header; they depend on nothing but the size, so every encoder of one size yields the same
// header. Throws JobError when libavcodec lacks the codec or refuses the size.
CodecContext openFfv1(int width, int height);

}  // namespace echocine
