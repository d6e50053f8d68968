#include <algorithm>
#include <cmath>

#include "core/hash.h"
#include "core/seal.h"
#include "echo/ecg_trace.h"
#include "echo/render_folder.h"
#include "promises.h"
#include "targets.h"
#include "video/cine_writer.h"

namespace echocine::fuzz {

namespace {

constexpr int kFrames = 4, kWidth = 64, kHeight = 48;

// Its cine is sound; the manifest is the fuzzer's.
const std::filesystem::path& renderedFolder() {
  static const std::filesystem::path folder = [] {
    const std::filesystem::path made = scratchFolder() / "loop";
    std::filesystem::create_directories(made);
    OutputSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    CineWriter cine(made / "cine.avi", settings, 25);
    GreyImage image{kWidth, kHeight, {}};
    for (int f = 0; f < kFrames; ++f) {
      image.pixels.assign(kWidth * kHeight, static_cast<std::uint8_t>(40 * f));
      cine.add(encodeCineFrame(image, settings.codec, settings.jpeg_quality));
    }
    cine.finish();
    return made;
  }();
  return folder;
}

// Bytes that begin anew at their end.
class Tape {
 public:
  explicit Tape(std::string_view bytes) : bytes_(bytes) {}
  int at(std::size_t i) const {
    return bytes_.empty() ? 0 : static_cast<unsigned char>(bytes_[i % bytes_.size()]);
  }

 private:
  std::string_view bytes_;
};

constexpr int kEcgWidth = 160, kEcgHeight = 132, kEcgTop = 100;

// A curve through the band below the sector, at each column as high as its byte says.
void drawCurve(const Tape& tape, std::size_t from, int first, int last, PixelPlane& picture) {
  const auto rowOf = [&](int x) {
    return kEcgTop + tape.at(from + static_cast<std::size_t>(x)) % (kEcgHeight - kEcgTop);
  };
  for (int x = std::max(first, 1); x < std::min(last, kEcgWidth); ++x) {
    const auto [low, high] = std::minmax({rowOf(x - 1), rowOf(x)});
    for (int y = low; y <= high; ++y) picture[static_cast<std::size_t>(y * kEcgWidth + x)] = 200;
  }
}

// Frames of a sweep, of a scrolling curve, of a still one with a marker, or of plain bytes.
Video ecgVideo(const Tape& tape) {
  Video video;
  video.width = kEcgWidth;
  video.height = kEcgHeight;
  video.rate = {25, "fuzz", true};
  const int frames = 2 + tape.at(0) % 30, kind = tape.at(1) % 4, step = 1 + tape.at(2) % 12,
            gap = tape.at(3) % 24;
  for (int f = 0; f < frames; ++f) {
    PixelPlane picture(kEcgWidth * kEcgHeight, 0);
    const int head = f * step % kEcgWidth;
    const auto drawn = [&](int from, int first, int last) {
      drawCurve(tape, static_cast<std::size_t>(4 + from), first, last, picture);
    };
    if (kind == 0) {
      drawn(f * step / kEcgWidth * kEcgWidth, 0, head);
      drawn((f * step / kEcgWidth + 1) * kEcgWidth, head + gap, kEcgWidth);
    } else if (kind == 1) {
      drawn(f * step, 0, kEcgWidth);
    } else if (kind == 2) {
      drawn(0, 0, kEcgWidth);
      for (int y = kEcgTop; y < kEcgHeight; ++y)
        picture[static_cast<std::size_t>(y * kEcgWidth + head)] = 180;
    } else {
      for (std::size_t i = kEcgTop * kEcgWidth; i < picture.size(); ++i)
        picture[i] = static_cast<std::uint8_t>(tape.at(i + static_cast<std::size_t>(97 * f)));
    }
    video.frames.push_back(std::move(picture));
  }
  video.coloured.assign(video.frames.front().size(), 0);
  return video;
}

}  // namespace

void folder(std::string_view bytes) {
  const std::filesystem::path& rendered = renderedFolder();
  // Sealed and with the cine's digest, so that more than digests is read.
  static const std::string cine = sha256HexOfFile(rendered / "cine.avi");
  const std::string object(bytes.substr(0, bytes.rfind('}')));
  std::ofstream(rendered / "manifest.json", std::ios::binary)
      << sealed(object + ",\n \"files\": {\"cine.avi\": \"" + cine + "\"}\n}");
  accepts([&] {
    const echo::EchoLoop loop = echo::readRenderFolder(rendered);
    promise(loop.phases.size() == kFrames, "a loop of another length");
    promise(*loop.metres_per_pixel > 0, "a picture without a scale");
    for (const auto& [name, ml] : loop.volumes_ml)
      promise(ml.size() == kFrames, "volumes of other frames: " + name);
  });
}

void ecg(std::string_view bytes) {
  const Video video = ecgVideo(Tape(bytes));
  const echo::Sector sector{80, 2, -0.7, 0.7, 5, 92};
  const auto trace = echo::readEcg(video, sector, 0);
  if (!trace) return;
  promise(trace->confidence >= 0 && trace->confidence <= 1, "a confidence beyond 0 and 1");
  promise(trace->left >= 0 && trace->left <= trace->right && trace->right < kEcgWidth &&
              trace->top >= 0 && trace->top <= trace->bottom && trace->bottom < kEcgHeight,
          "a trace outside of the picture");
  promise(std::is_sorted(trace->r_frames.begin(), trace->r_frames.end()), "R waves out of order");
  for (const double frame : trace->r_frames) promise(std::isfinite(frame), "an R wave at no time");
  if (const auto beat = echo::usualBeat(*trace, video.frameCount()))
    promise(beat->frames > 0 && std::isfinite(beat->r_frame), "a beat of no length");
}

}  // namespace echocine::fuzz
