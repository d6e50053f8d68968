#include "fit/fit_controls.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/hash_random.h"

namespace echocine::fit {

namespace {

void mirror(PixelPlane& plane, int width) {
  for (auto row = plane.begin(); row != plane.end(); row += width) std::reverse(row, row + width);
}

// The pose of lowest D of a heart in a loop of beatOnly().
double fitted(const echo::EchoLoop& loop, double systole, const ModelLoop& heart,
              const std::vector<FitPose>& from) {
  // Limits of an end-systole that is given, with a margin.
  constexpr double kEarliest = 0.16, kLatest = 0.69;
  echo::SideOptions side;
  side.ed_frame = 0;
  if (systole > 0) side.es_frame = kFitFrames * std::clamp(systole, kEarliest, kLatest);
  const ModelDiscrepancy discrepancy(loop, side, heart);
  return from.empty() ? discrepancy.search(heart).discrepancy
                      : discrepancy.searchAlsoFrom(heart, from).discrepancy;
}

}  // namespace

echo::EchoLoop beatOnly(const echo::EchoLoop& loop, const echo::BeatSpan& beat) {
  echo::EchoLoop out = loop;
  out.ecg.reset();
  out.video.r_waves_s.clear();
  out.video.frames.clear();
  out.traced = {};
  out.volumes_ml.clear();
  out.phases.clear();
  out.frames_per_beat = kFitFrames;
  const int frames = loop.video.frameCount();
  for (int n = 0; n < kFitFrames; ++n) {
    double place = beat.end_diastole + beat.frames * n / kFitFrames;
    while (place > frames - 1) place -= beat.frames;
    const auto nearest =
        static_cast<std::size_t>(std::clamp(std::lround(place), 0L, static_cast<long>(frames) - 1));
    out.video.frames.push_back(loop.video.frames[nearest]);
  }
  out.video.rate.hz = loop.video.rate.hz * kFitFrames / beat.frames;
  return out;
}

echo::EchoLoop mirrored(echo::EchoLoop loop) {
  for (PixelPlane& frame : loop.video.frames) mirror(frame, loop.video.width);
  mirror(loop.overlay, loop.video.width);
  mirror(loop.video.coloured, loop.video.width);
  echo::Sector& sector = loop.find.sector;
  sector.apex_x = loop.video.width - sector.apex_x;
  std::swap(sector.first_rad, sector.last_rad);
  sector.first_rad *= -1;
  sector.last_rad *= -1;
  return loop;
}

echo::EchoLoop shuffled(echo::EchoLoop loop) {
  constexpr std::uint64_t kSeed = 57;
  std::vector<std::size_t> order(loop.video.frames.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return hashOf(kSeed, a, std::uint64_t{0}) < hashOf(kSeed, b, std::uint64_t{0});
  });
  std::vector<PixelPlane> frames;
  for (const std::size_t n : order) frames.push_back(std::move(loop.video.frames[n]));
  loop.video.frames = std::move(frames);
  return loop;
}

ControlFits controlFits(const echo::EchoLoop& loop, const echo::BeatSpan& beat,
                        const ModelLoop& heart, const FitPose& from) {
  const echo::EchoLoop own = beatOnly(loop, beat);
  FitPose near = from;
  near.lag = 0;
  near.systole = 0;
  return {fitted(own, beat.systole, heart, {near}), fitted(mirrored(own), beat.systole, heart, {}),
          fitted(shuffled(own), beat.systole, heart, {near})};
}

}  // namespace echocine::fit
