// Resuming: is a file that an earlier run left behind the very one this run would write?

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "core/hash.h"
#include "core/usable.h"
#include "output/exr_attribute.h"
#include "output/exr_digest.h"
#include "output/exr_header.h"
#include "output/exr_stack.h"

namespace echocine {
namespace {

// Content of a frame's file. A complete frame of another scene is a user's mistake and must not be
// overwritten; a damaged file may be.
enum class Found { nothing, another_scene, this_frame };

bool hasSize(const Imf::Header& header, const Probe& probe) {
  return header.dataWindow() == Imath::Box2i({0, 0}, {probe.lines - 1, probe.samples - 1});
}

// Exactly those: a frame with more or fewer was rendered for other settings.
bool hasChannels(const Imf::Header& header, const std::vector<Channel>& wanted) {
  std::set<std::string> names;
  for (const Channel channel : wanted) names.insert(channelName(channel));
  std::set<std::string> found;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
    found.insert(it.name());
  return names == found;
}

// One row of one channel.
struct ChannelRow {
  bool is_float = true;
  bool is_motion = false;     // may be negative, or unknown
  std::vector<float> values;  // of an integer channel: its bit patterns
};

// A frame buffer that puts every row of the file into the same memory; empty rows when the layout
// is none that ExrStack writes.
Imf::FrameBuffer rowBuffer(const Imf::Header& header, std::vector<ChannelRow>& rows) {
  const Imath::Box2i& window = header.dataWindow();
  Imf::FrameBuffer buffer;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    const Imf::Channel& channel = it.channel();
    if (window.min != Imath::V2i(0, 0) || channel.xSampling != 1 || channel.ySampling != 1) {
      rows.clear();
      return {};
    }
    const bool is_float = channel.type != Imf::UINT;  // half floats are widened on reading
    const bool is_motion = std::any_of(
        kTruthChannels.begin(), kTruthChannels.end(),
        [&](Channel c) { return isMotion(c) && it.name() == std::string_view(channelName(c)); });
    rows.push_back(
        {is_float, is_motion, std::vector<float>(static_cast<std::size_t>(window.max.x) + 1)});
    // Every row lands in the same memory: the values are looked at and thrown away.
    const std::size_t row_stride = 0;
    buffer.insert(it.name(), Imf::Slice(is_float ? Imf::FLOAT : Imf::UINT,
                                        reinterpret_cast<char*>(rows.back().values.data()),
                                        sizeof(float), row_stride));
  }
  return buffer;
}

// Reads every pixel; an unreadable one throws. False when the layout or a value is none that
// ExrStack writes, which only damage can explain.
bool pixelsAreWhole(Imf::InputFile& file) {
  std::vector<ChannelRow> rows;
  const Imf::FrameBuffer buffer = rowBuffer(file.header(), rows);
  if (rows.empty()) return false;
  file.setFrameBuffer(buffer);
  for (int y = 0; y <= file.header().dataWindow().max.y; ++y) {
    file.readPixels(y);
    for (const ChannelRow& row : rows)
      if (row.is_float && !row.is_motion && firstUnusable(row.values)) return false;
  }
  return true;
}

// Whether a header is what ExrStack::write gives this frame, the scene apart.
bool isThisFrame(const Imf::Header& header, const FrameRecord& record, const Scene& scene,
                 double reference_intensity) {
  return hasSize(header, scene.probe) && hasChannels(header, scene.output.channels) &&
         holds<Imf::IntAttribute>(header, "echocine:frame", record.frame) &&
         holds<Imf::DoubleAttribute>(header, "echocine:reference_intensity", reference_intensity) &&
         holds<Imf::StringAttribute>(header, "echocine:version", std::string(ECHOCINE_VERSION));
}

// Whose scene a header is of. Two scenes differ in some 60 of the 64 digits; one that differs in a
// few is this one, damaged. A file without any attribute of ours is somebody else's.
enum class Owner { this_scene, damaged, another_scene };

Owner ownerOf(const Imf::Header& header, const std::string& scene_sha256) {
  constexpr std::ptrdiff_t kDamagedDigits = 8;
  const auto* attribute = header.findTypedAttribute<Imf::StringAttribute>("echocine:scene_sha256");
  if (attribute == nullptr) {
    const bool ours = header.find(kExrDigestName) != header.end() ||
                      header.find("echocine:frame") != header.end();
    return ours ? Owner::damaged : Owner::another_scene;
  }
  const std::string& found = attribute->value();
  if (found == scene_sha256) return Owner::this_scene;
  if (found.size() != scene_sha256.size()) return Owner::damaged;
  std::ptrdiff_t differ = 0;
  for (std::size_t i = 0; i < found.size(); ++i) differ += found[i] != scene_sha256[i] ? 1 : 0;
  return differ <= kDamagedDigits ? Owner::damaged : Owner::another_scene;
}

// Cheap checks first: the pixels, which take longest, are read last.
Found look(const std::filesystem::path& path, const FrameRecord& record, const Scene& scene,
           const std::string& scene_sha256, double reference_intensity) {
  try {
    std::error_code absent;
    if (!std::filesystem::is_regular_file(path, absent) || !hasPlainExrHeader(path))
      return Found::nothing;
    Imf::InputFile file(path.c_str(), 0);
    const Imf::Header& header = file.header();
    if (!file.isComplete()) return Found::nothing;
    switch (ownerOf(header, scene_sha256)) {
      case Owner::damaged:
        return Found::nothing;
      case Owner::another_scene:
        return pixelsAreWhole(file) ? Found::another_scene : Found::nothing;
      case Owner::this_scene:
        break;
    }
    const bool this_frame =
        isThisFrame(header, record, scene, reference_intensity) && isSealedExr(path);
    return this_frame ? Found::this_frame : Found::nothing;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {  // absent, cut short, or no OpenEXR file at all
    return Found::nothing;
  }
}

[[noreturn]] void failOfOtherScene(const std::filesystem::path& path) {
  throw SceneError(
      fmt::format("{}: belongs to another scene: choose another folder or render without --resume",
                  path.string()));
}

}  // namespace

bool ExrStack::isOfAnotherScene(int frame) const {
  const std::filesystem::path path = folder_ / fileName(frame);
  std::error_code absent;
  if (!std::filesystem::is_regular_file(path, absent) || !hasPlainExrHeader(path)) return false;
  try {
    return ownerOf(Imf::InputFile(path.c_str(), 0).header(), scene_sha256_) == Owner::another_scene;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {  // without a header it is of no scene
    return false;
  }
}

void ExrStack::refuseOtherScene(int frame) const {
  if (isOfAnotherScene(frame)) failOfOtherScene(folder_ / fileName(frame));
}

std::string ExrStack::existing(const FrameRecord& record) const {
  const std::filesystem::path path = folder_ / fileName(record.frame);
  switch (look(path, record, scene_, scene_sha256_, reference_intensity_)) {
    case Found::this_frame:
      return sha256HexOfFile(path);
    case Found::another_scene:
      failOfOtherScene(path);
    case Found::nothing:
      break;
  }
  return {};
}

}  // namespace echocine
