#include "output/exr_read_back.h"

#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>

#include <cstring>
#include <stdexcept>
#include <string>

namespace echocine {
namespace {

class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(std::span<const std::byte> bytes) : IStream("memory"), bytes_(bytes) {}

  bool read(char to[], int size) override {
    const auto count = static_cast<std::size_t>(size);
    if (position_ > bytes_.size() || count > bytes_.size() - position_)
      throw std::runtime_error("read past the end");
    std::memcpy(to, bytes_.data() + position_, count);
    position_ += count;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
};

}  // namespace

std::vector<float> readBack(std::span<const std::byte> file, Channel channel) {
  MemoryInput stream(file);
  Imf::InputFile in(stream, 0);
  const Imath::Box2i window = in.header().dataWindow();
  const auto lines = static_cast<std::size_t>(window.max.x) + 1;
  const auto samples = static_cast<std::size_t>(window.max.y) + 1;
  std::vector<float> values(lines * samples);
  Imf::FrameBuffer buffer;
  buffer.insert(channelName(channel), Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()),
                                                 sizeof(float) * samples, sizeof(float)));
  in.setFrameBuffer(buffer);
  in.readPixels(0, window.max.y);
  const auto* scale = in.header().findTypedAttribute<Imf::DoubleAttribute>(
      std::string("echocine:scale.") + channelName(channel));
  if (scale != nullptr)
    for (float& value : values)
      value = static_cast<float>(static_cast<double>(value) / scale->value());
  return values;
}

}  // namespace echocine
