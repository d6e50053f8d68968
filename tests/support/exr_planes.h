#pragma once
// Channels of a written EXR, by the library's own reader.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace echocine::support {

struct ExrPlane {
  int lines = 0, samples = 0;
  std::vector<std::uint32_t> bits;  // row-major: sample by sample, lines within; bit patterns
};

inline ExrPlane exrPlane(const std::filesystem::path& file, const char* channel) {
  Imf::InputFile in(file.c_str());
  const Imath::Box2i window = in.header().dataWindow();
  ExrPlane plane{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, {}};
  plane.bits.resize(static_cast<std::size_t>(plane.lines) *
                    static_cast<std::size_t>(plane.samples));
  const Imf::Channel* found = in.header().channels().findChannel(channel);
  if (found == nullptr) return {};
  Imf::FrameBuffer buffer;
  buffer.insert(channel, Imf::Slice(found->type, reinterpret_cast<char*>(plane.bits.data()), 4,
                                    4 * static_cast<std::size_t>(plane.lines)));
  in.setFrameBuffer(buffer);
  in.readPixels(window.min.y, window.max.y);
  return plane;
}

}  // namespace echocine::support
