#include "output/exr_plane.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>

#include <cstring>
#include <stdexcept>

#include "core/usable.h"
#include "output/exr_attribute.h"
#include "output/exr_header.h"

namespace echocine {

namespace {

bool isWanted(const Imf::Header& header, const ExrPlaneWanted& wanted) {
  const Imf::Channel* channel = header.channels().findChannel(channelName(wanted.channel));
  return header.dataWindow() == Imath::Box2i({0, 0}, {wanted.lines - 1, wanted.samples - 1}) &&
         holds<Imf::StringAttribute>(header, "echocine:scene_sha256", wanted.scene_sha256) &&
         holds<Imf::IntAttribute>(header, "echocine:frame", wanted.frame) && channel != nullptr &&
         (channel->type == Imf::UINT) == isLabel(wanted.channel) && channel->xSampling == 1 &&
         channel->ySampling == 1;
}

// Line-major; floats widened and the scale of half floats undone.
template <typename Value>
std::vector<Value> channelOf(Imf::InputFile& file, Channel channel, Imf::PixelType type) {
  const Imath::Box2i window = file.header().dataWindow();
  const auto lines = static_cast<std::size_t>(window.max.x) + 1,
             samples = static_cast<std::size_t>(window.max.y) + 1;
  std::vector<Value> values(lines * samples);
  const std::string name = channelName(channel);
  Imf::FrameBuffer buffer;
  buffer.insert(name, Imf::Slice(type, reinterpret_cast<char*>(values.data()),
                                 sizeof(Value) * samples, sizeof(Value)));
  file.setFrameBuffer(buffer);
  file.readPixels(0, window.max.y);
  const auto* scale =
      file.header().findTypedAttribute<Imf::DoubleAttribute>("echocine:scale." + name);
  // In double: the scale is a power of two and may lie beyond a float's range.
  if (scale != nullptr)
    for (Value& v : values) v = static_cast<Value>(static_cast<double>(v) / scale->value());
  return values;
}

// The library reads through this what was just encoded, without a file.
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

namespace {

// What `take` makes of the file, if it is the one that is wanted.
template <typename Value, typename Take>
std::optional<std::vector<Value>> readWanted(const std::filesystem::path& path,
                                             const ExrPlaneWanted& wanted, const Take& take) {
  try {
    std::error_code absent;
    if (!std::filesystem::is_regular_file(path, absent) || !hasPlainExrHeader(path))
      return std::nullopt;
    Imf::InputFile file(path.c_str(), 0);
    if (!file.isComplete() || !isWanted(file.header(), wanted)) return std::nullopt;
    return take(file);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {  // cut short, or no OpenEXR file at all
    return std::nullopt;
  }
}

}  // namespace

std::optional<std::vector<float>> readExrPlane(const std::filesystem::path& path,
                                               const ExrPlaneWanted& wanted) {
  using Plane = std::optional<std::vector<float>>;
  return readWanted<float>(path, wanted, [&](Imf::InputFile& file) -> Plane {
    std::vector<float> values = channelOf<float>(file, wanted.channel, Imf::FLOAT);
    // A scale that is none makes such too. Motion has a sign, and is not a number where it is
    // unknown.
    if (!isMotion(wanted.channel) && firstUnusable(values)) return std::nullopt;
    return values;
  });
}

std::optional<std::vector<std::uint32_t>> readExrIds(const std::filesystem::path& path,
                                                     const ExrPlaneWanted& wanted) {
  using Plane = std::optional<std::vector<std::uint32_t>>;
  return readWanted<std::uint32_t>(path, wanted, [&](Imf::InputFile& file) -> Plane {
    return channelOf<std::uint32_t>(file, wanted.channel, Imf::UINT);
  });
}

std::vector<float> readBack(std::span<const std::byte> file, Channel channel) {
  MemoryInput stream(file);
  Imf::InputFile in(stream, 0);
  return channelOf<float>(in, channel, Imf::FLOAT);
}

}  // namespace echocine
