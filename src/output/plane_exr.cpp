#include "output/plane_exr.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <new>

#include "core/check.h"
#include "core/error.h"
#include "output/exr_digest.h"
#include "output/exr_memory.h"

namespace echocine {

std::vector<std::byte> encodePlaneExr(const PlaneExr& exr) {
  Imf::Header header(exr.width, exr.height, 1.0f, Imath::V2f(0, 0), 1.0f, Imf::INCREASING_Y,
                     Imf::ZIP_COMPRESSION);
  for (const auto& [name, value] : exr.numbers) header.insert(name, Imf::DoubleAttribute(value));
  for (const auto& [name, text] : exr.texts) header.insert(name, Imf::StringAttribute(text));
  header.insert(kExrDigestName, Imf::StringAttribute(emptyExrDigest()));
  const auto width = static_cast<std::size_t>(exr.width);
  Imf::FrameBuffer buffer;
  for (const auto& [name, values] : exr.channels) {
    CHECK_EQ(values.size(), width * static_cast<std::size_t>(exr.height));
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    // The library reads the pixels only.
    auto* pixels = const_cast<char*>(reinterpret_cast<const char*>(values.data()));
    buffer.insert(name, Imf::Slice(Imf::FLOAT, pixels, sizeof(float), width * sizeof(float)));
  }
  std::vector<std::byte> bytes;
  ExrMemory stream("planes", bytes);
  try {
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(exr.height);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw JobError(fmt::format("EXR planes cannot be encoded: {}", error.what()));
  }
  sealExr(bytes);
  return bytes;
}

}  // namespace echocine
