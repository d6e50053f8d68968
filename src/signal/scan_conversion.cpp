#include "signal/scan_conversion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "core/lanes.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

constexpr int kGreySteps = 4096;  // of the grey map: sixteen per grey level
constexpr float kWhole = 65535;   // a weight of 1: the next step of 16 bits errs by under 1e-5

// Pixels of a strip that is made from top to bottom: what it reads of the lines stays in the
// first-level cache from row to row.
constexpr int kStrip = 64;

using ByteLanes = std::uint8_t __attribute__((vector_size(kFloatLanes)));

}  // namespace

PictureGeometry pictureGeometry(const Scene& scene) {
  const OutputSettings& o = scene.output;
  PictureGeometry g;
  g.ecg_strip_px = o.ecg && o.pictures() ? o.height / 8 : 0;
  const double margin = 0.02 * o.height;
  const double tick_room =
      o.depth_ticks ? 0.05 * o.width : 0;  // on both sides, so the sector stays centred
  Box area = scanBox(scene.probe);
  area.add(lineGeometry(scene.probe, 0).origin);
  const double wide = o.width - 2 * margin - 2 * tick_room;
  const double high = o.height - g.ecg_strip_px - 2 * margin;
  g.metres_per_pixel = std::max((area.hi.x - area.lo.x) / wide, (area.hi.z - area.lo.z) / high);
  if (g.metres_per_pixel <= 0) g.metres_per_pixel = scene.probe.max_depth_m / high;
  g.origin_x_px = o.width / 2.0 - (area.lo.x + area.hi.x) / 2 / g.metres_per_pixel;
  g.origin_y_px = margin + high / 2 - (area.lo.z + area.hi.z) / 2 / g.metres_per_pixel;
  return g;
}

ScanConverter::ScanConverter(const Probe& probe, const PictureGeometry& geometry, int width,
                             int height, const GreyCurve& grey_curve, int averaged)
    : width_(width),
      height_(height),
      next_line_(probe.lines > 1 ? static_cast<std::size_t>(std::max(probe.samples, 2)) : 0),
      single_sample_(probe.samples == 1),
      full_turn_(probe.isFullTurn()),
      averaged_(averaged) {
  for (int x = 0; x < width; x += kStrip)
    for (int y = 0; y < height; ++y) addRow(probe, geometry, x, std::min(x + kStrip, width), y);
  for (int i = 0; !grey_curve.isIdentity() && i <= kGreySteps; ++i)
    grey_map_.push_back(static_cast<std::uint8_t>(
        std::lround(255 * grey_curve.at(static_cast<double>(i) / kGreySteps))));
  if (averaged == 1) return;
  PictureGeometry fine = geometry;
  fine.metres_per_pixel /= averaged;
  fine.origin_x_px *= averaged;
  fine.origin_y_px *= averaged;
  fine_ = std::make_unique<const ScanConverter>(probe, fine, width * averaged, height * averaged,
                                                GreyCurve());
}

int ScanConverter::averagedOver(const Scene& scene, const PictureGeometry& geometry) {
  const double sample_m = scene.probe.sampleSpacing();
  const double pulse_m = scene.signal.pulse_cycles * ScanGeometry(scene.probe).wavelength() / 2;
  if (geometry.metres_per_pixel <= std::max(sample_m, pulse_m)) return 1;
  const double steps = std::ceil(geometry.metres_per_pixel / sample_m);
  return static_cast<int>(std::clamp(steps, 2.0, double{kMostAveraged}));
}

void ScanConverter::addRow(const Probe& probe, const PictureGeometry& geometry, int begin, int end,
                           int y) {
  bool inside = false;
  for (int x = begin; x < end; ++x) {
    const std::optional<ScanGeometry::BeamPosition> beam = ScanGeometry(probe).beamPosition(
        (x + 0.5 - geometry.origin_x_px) * geometry.metres_per_pixel,
        (y + 0.5 - geometry.origin_y_px) * geometry.metres_per_pixel);
    if (!beam || beam->path_m < probe.min_depth_m || beam->path_m > probe.max_depth_m) {
      inside = false;
      continue;
    }
    const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(x);
    if (!inside) runs_.push_back({pixel, 0, blocks_.size()});
    inside = true;
    const auto lane = static_cast<int>(runs_.back().count++ % kFloatLanes);
    if (lane == 0) blocks_.push_back({});
    setEntry(probe, beam->line, beam->path_m, blocks_.back(), lane);
  }
}

void ScanConverter::setEntry(const Probe& probe, double line, double path_m, Block& block,
                             int lane) const {
  const auto split = [](double position, int count, std::uint32_t& weight) {
    const double inside = std::clamp(position, 0.0, count - 1.0);
    const double whole = std::min(std::floor(inside), std::max(count - 2.0, 0.0));
    weight = static_cast<std::uint32_t>(std::lround(kWhole * (inside - whole)));
    return static_cast<std::uint32_t>(whole);
  };
  std::uint32_t across = 0, along = 0;
  // Over a full turn, line 0 follows the last one.
  const std::uint32_t left = split(line, probe.lines + (full_turn_ ? 1 : 0), across);
  const double sample = (path_m - probe.min_depth_m) / probe.sampleSpacing() - 0.5;
  const std::uint32_t above = split(sample, probe.samples, along);
  block.weights[lane] = across << 16 | along;
  block.sample[lane] = left * static_cast<std::uint32_t>(std::max(probe.samples, 2)) + above;
}

namespace {

// The values at eight places and one after each.
struct Neighbours {
  Floats8 first, second;
};

Neighbours neighbours(const float* plane, const std::uint32_t* places) {
  using Pairs = double __attribute__((vector_size(kFloatLanes * sizeof(float))));  // of floats
  const auto pair = [&](int i) {
    double both;
    std::memcpy(&both, plane + places[i], sizeof both);
    return both;
  };
  const auto a = std::bit_cast<Floats8>(Pairs{pair(0), pair(1), pair(4), pair(5)});
  const auto b = std::bit_cast<Floats8>(Pairs{pair(2), pair(3), pair(6), pair(7)});
  return {__builtin_shufflevector(a, b, 0, 2, 8, 10, 4, 6, 12, 14),
          __builtin_shufflevector(a, b, 1, 3, 9, 11, 5, 7, 13, 15)};
}

// Weights of both directions, 16 bits each.
struct Weights {
  Floats8 across, along;
};

Weights weights(const std::uint32_t* parts) {
  const Ints8 both = intsAt(parts);
  const auto share = [](Ints8 part) {
    return __builtin_convertvector(part, Floats8) * (1 / kWhole);
  };
  return {share(std::bit_cast<Ints8>(std::bit_cast<Uints8>(both) >> 16)), share(both & 0xffff)};
}

// Steps of 0..255. A conversion would take them one by one.
ByteLanes greysOf(Ints8 steps) {
  using Bytes = std::uint8_t __attribute__((vector_size(sizeof(Ints8))));
  const auto bytes = std::bit_cast<Bytes>(steps);
  static_assert(std::endian::native == std::endian::little);
  return __builtin_shufflevector(bytes, bytes, 0, 4, 8, 12, 16, 20, 24, 28);
}

}  // namespace

// Calls put(pixel, values, count) for every eight pixels of a run, `count` of them its own.
template <typename Put>
void ScanConverter::forRuns(std::span<const float> grey, const Put& put) const {
  std::vector<float> turn, doubled;
  if (full_turn_) {
    turn.reserve(grey.size() + next_line_);
    turn.assign(grey.begin(), grey.end());
    const std::size_t samples = single_sample_ ? 1 : next_line_;
    turn.insert(turn.end(), grey.begin(), grey.begin() + static_cast<std::ptrdiff_t>(samples));
    grey = turn;
  }
  if (single_sample_)
    for (const float g : grey) doubled.insert(doubled.end(), {g, g});
  const float* left = single_sample_ ? doubled.data() : grey.data();
  const float* right = left + next_line_;
  for (const Run& run : runs_) {
    const Block* block = &blocks_[run.block];
    for (std::size_t i = 0; i < run.count; i += kFloatLanes, ++block) {
      __builtin_prefetch(block + 32);  // the table is read through once a picture
      const Neighbours l = neighbours(left, block->sample);
      const Neighbours r = neighbours(right, block->sample);
      const Weights w = weights(block->weights);
      const Floats8 a = l.first + w.along * (l.second - l.first);
      const Floats8 b = r.first + w.along * (r.second - r.first);
      put(run.pixel + i, a + w.across * (b - a), std::min<std::size_t>(kFloatLanes, run.count - i));
    }
  }
}

// Each pixel of the table takes the mean of the fine ones in it that lie in the scan area; one at
// a tip that holds none keeps its own value.
void ScanConverter::averageFine(std::span<const float> grey, std::vector<float>& picture) const {
  thread_local std::vector<float> fine;
  fine_->convert(grey, fine);
  const auto n = static_cast<std::size_t>(averaged_), width = static_cast<std::size_t>(width_);
  for (std::size_t pixel = 0; pixel < picture.size(); ++pixel) {
    if (picture[pixel] < 0) continue;
    const float* row = &fine[(pixel / width * n * width + pixel % width) * n];
    double sum = 0;
    int count = 0;
    for (std::size_t y = 0; y < n; ++y, row += n * width)
      for (std::size_t x = 0; x < n; ++x) {
        if (row[x] < 0) continue;
        sum += static_cast<double>(row[x]);
        ++count;
      }
    if (count > 0) picture[pixel] = static_cast<float>(sum / count);
  }
}

void ScanConverter::mapGreys(std::span<const float> picture, GreyImage& image) const {
  const float steps = grey_map_.empty() ? 255.0f : float{kGreySteps};
  for (std::size_t pixel = 0; pixel < picture.size(); ++pixel) {
    if (picture[pixel] < 0) continue;
    const auto step = static_cast<std::size_t>(picture[pixel] * steps + 0.5f);
    image.pixels[pixel] = grey_map_.empty() ? static_cast<std::uint8_t>(step) : grey_map_[step];
  }
}

void ScanConverter::convert(std::span<const float> grey, GreyImage& image) const {
  image.width = width_;
  image.height = height_;
  image.pixels.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  if (fine_) {
    thread_local std::vector<float> picture;
    convert(grey, picture);
    mapGreys(picture, image);
    return;
  }
  std::uint8_t* const pixels = image.pixels.data();
  const auto put = [pixels](std::size_t pixel, ByteLanes greys, std::size_t count) {
    if (count == kFloatLanes)
      std::memcpy(pixels + pixel, &greys, kFloatLanes);  // a plain store
    else
      std::memcpy(pixels + pixel, &greys, count);
  };
  if (grey_map_.empty()) {
    forRuns(grey, [&](std::size_t pixel, Floats8 values, std::size_t count) {
      const auto steps = __builtin_convertvector(values * 255.0f + 0.5f, Ints8);
      put(pixel, greysOf(steps), count);
    });
    return;
  }
  forRuns(grey, [&](std::size_t pixel, Floats8 values, std::size_t count) {
    const auto steps = __builtin_convertvector(values * float{kGreySteps} + 0.5f, Ints8);
    ByteLanes greys{};
    for (std::size_t i = 0; i < kFloatLanes; ++i)
      greys[i] = grey_map_[static_cast<std::size_t>(steps[i])];
    put(pixel, greys, count);
  });
}

void ScanConverter::convert(std::span<const float> grey, std::vector<float>& picture) const {
  picture.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), -1.0f);
  forRuns(grey, [&](std::size_t pixel, Floats8 values, std::size_t count) {
    std::memcpy(&picture[pixel], &values, count * sizeof(float));
  });
  if (fine_) averageFine(grey, picture);
}

}  // namespace echocine
