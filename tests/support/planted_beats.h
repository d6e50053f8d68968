#pragma once
// Loops of several beats of known length, without or with gaps in their R waves.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/hash_random.h"
#include "echo/echo_loop.h"

namespace echocine::support {

// Random parameters of one loop.
struct BeatDraw {
  std::vector<double> phases;   // of each frame, in beats from the first R wave before the loop
  std::vector<double> r_waves;  // within the loop, in frames
  double frames_per_beat = 0;   // mean over the loop
  double breath_beats = 0, breath_share = 0, breath_px = 0;  // period, share of the second plane
  double noise_grey = 0;                                     // standard deviation for each pixel
  bool rate_known = false;
  std::uint64_t seed = 0;
};

// Loop `number` of an endless list, `least` to `most` beats long. Intervals between R waves vary by
// up to 4 % either way.
inline BeatDraw beatDraw(std::uint64_t number, double least, double most) {
  const auto drawn = [&](std::uint64_t k, double low, double high) {
    return low + (high - low) * uniformFromHash(hashOf(number, k, 4711));
  };
  BeatDraw out;
  const double length = 14 * std::pow(60.0 / 14, drawn(1, 0, 1)), beats = drawn(2, least, most);
  const int frames = static_cast<int>(std::lround(beats * length));
  double wave = -drawn(3, 0, 1) * length;
  for (int beat = 0; out.phases.size() < static_cast<std::size_t>(frames); ++beat) {
    const double next = wave + length * drawn(100 + static_cast<std::uint64_t>(beat), 0.96, 1.04);
    for (int f = static_cast<int>(out.phases.size()); f < next && f < frames; ++f)
      out.phases.push_back(beat + (f - wave) / (next - wave));
    if (wave >= 0) out.r_waves.push_back(wave);
    wave = next;
  }
  out.frames_per_beat = (frames - 1) / (out.phases.back() - out.phases.front());
  out.breath_beats = drawn(4, 2.5, 6);
  out.breath_share = drawn(5, 0, 1);
  out.breath_px = drawn(6, 0, 6);
  out.noise_grey = drawn(7, 0, 40);
  out.rate_known = drawn(8, 0, 1) < 0.5;
  out.seed = number;
  return out;
}

// The loop of a draw from one rendered beat in two planes; breathing blends and shifts them.
inline echo::EchoLoop loopOf(const BeatDraw& draw, const echo::EchoLoop& one,
                             const echo::EchoLoop& other) {
  echo::EchoLoop loop = one;
  loop.frames_per_beat = 0;
  loop.video.frames.clear();
  loop.video.rate = {draw.rate_known ? draw.frames_per_beat / 0.9 : 30, "planted", draw.rate_known};
  const std::size_t n = one.video.frames.size();
  const int width = one.video.width, height = one.video.height;
  for (std::size_t f = 0; f < draw.phases.size(); ++f) {
    const double at = (draw.phases[f] - std::floor(draw.phases[f])) * static_cast<double>(n),
                 breath = 0.5 -
                          0.5 * std::cos(2 * std::numbers::pi * draw.phases[f] / draw.breath_beats +
                                         static_cast<double>(draw.seed)),
                 second = draw.breath_share * breath;
    const auto first = static_cast<std::size_t>(at) % n, next = (first + 1) % n;
    const double share = at - std::floor(at);
    const int shift = static_cast<int>(std::lround(draw.breath_px * breath));
    PixelPlane plane(one.video.frames.front().size(), 0);
    for (int y = 0; y + shift < height; ++y)
      for (int x = 0; x < width; ++x) {
        const auto from = static_cast<std::size_t>(y * width + x),
                   to = static_cast<std::size_t>((y + shift) * width + x);
        const auto mixed = [&](const echo::EchoLoop& of) {
          return (1 - share) * of.video.frames[first][from] + share * of.video.frames[next][from];
        };
        const double grey = (1 - second) * mixed(one) + second * mixed(other),
                     noise = std::sqrt(12.0) * (uniformFromHash(hashOf(draw.seed, f, to)) - 0.5);
        plane[to] =
            static_cast<std::uint8_t>(std::clamp(grey + draw.noise_grey * noise, 0.0, 255.0));
      }
    loop.video.frames.push_back(std::move(plane));
  }
  return loop;
}

}  // namespace echocine::support
