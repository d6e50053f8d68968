#include "output/exr_plane.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>

#include <cmath>

#include "output/exr_header.h"
#include "output/polar_plane.h"

namespace echocine {

namespace {

template <typename Attribute, typename Value>
bool holds(const Imf::Header& header, const char* name, const Value& value) {
  const auto* attribute = header.findTypedAttribute<Attribute>(name);
  return attribute != nullptr && attribute->value() == value;
}

bool isWanted(const Imf::Header& header, const ExrPlaneWanted& wanted) {
  const Imf::Channel* channel = header.channels().findChannel(channelName(wanted.channel));
  return header.dataWindow() == Imath::Box2i({0, 0}, {wanted.lines - 1, wanted.samples - 1}) &&
         holds<Imf::StringAttribute>(header, "echocine:scene_sha256", wanted.scene_sha256) &&
         holds<Imf::IntAttribute>(header, "echocine:frame", wanted.frame) && channel != nullptr &&
         channel->type != Imf::UINT && channel->xSampling == 1 && channel->ySampling == 1;
}

}  // namespace

std::optional<std::vector<float>> readExrPlane(const std::filesystem::path& path,
                                               const ExrPlaneWanted& wanted) {
  try {
    std::error_code absent;
    if (!std::filesystem::is_regular_file(path, absent) || !hasPlainExrHeader(path))
      return std::nullopt;
    Imf::InputFile file(path.c_str(), 0);
    if (!file.isComplete() || !isWanted(file.header(), wanted)) return std::nullopt;
    const auto lines = static_cast<std::size_t>(wanted.lines),
               samples = static_cast<std::size_t>(wanted.samples);
    std::vector<float> values(lines * samples);
    const std::string name = channelName(wanted.channel);
    Imf::FrameBuffer buffer;
    buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()),
                                   sizeof(float) * samples, sizeof(float)));
    file.setFrameBuffer(buffer);
    file.readPixels(0, wanted.samples - 1);
    const auto* scale =
        file.header().findTypedAttribute<Imf::DoubleAttribute>("echocine:scale." + name);
    if (scale != nullptr) {
      if (!(scale->value() > 0 && std::isfinite(scale->value()))) return std::nullopt;
      for (float& v : values) v = static_cast<float>(v / scale->value());
    }
    if (firstUnusable(values)) return std::nullopt;
    return values;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {  // cut short, or no OpenEXR file at all
    return std::nullopt;
  }
}

}  // namespace echocine
